// SPDX-License-Identifier: MIT
#include "safety/earthquake/shaking.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/landscape.h"

namespace topple::safety {
namespace {

using physics::gravity;

// After the record a body near its balance takes this many times 1 / p, at most, to make up its
// mind.
constexpr double longest_after = 50;
// A swing shorter than this times 1 / p counts as rest.
constexpr double longest_rest = 1e-3;

class Rocker {
  public:
    Rocker(const Profile& body, double friction)
        : height_(body.height_m),
          edge_{edge(body, body.ahead_m), edge(body, body.behind_m)},
          kept_{kept(body, body.ahead_m, body.behind_m), kept(body, body.behind_m, body.ahead_m)},
          starts_{threshold(body.ahead_m, body.rocks_ahead(friction)),
                  threshold(body.behind_m, body.rocks_behind(friction))} {}

    double fastest_p() const { return std::sqrt(std::max(edge_[0].p2, edge_[1].p2)); }
    // The least |a| at which it moves.
    double least_start() const { return std::min(starts_[0], starts_[1]); }
    bool rests() const { return resting_; }
    const Rocking& result() const { return result_; }

    // One step from acceleration a0 to a1, straight between them.
    void step(double a0, double a1, double seconds) {
        double left = seconds, now = a0;
        if (resting_) {
            const bool ahead = std::max(a0, a1) > starts_[0];
            if (!ahead && std::max(-a0, -a1) <= starts_[1]) return;
            resting_ = false;
            side_ = ahead ? 0 : 1;
            angle_ = speed_ = 0;
            // From where the acceleration suffices.
            const double start = ahead ? starts_[0] : -starts_[1];
            if (ahead ? a0 < start : a0 > start) {
                left *= (a1 - start) / (a1 - a0);
                now = start;
            }
        }
        while (left > 0 && !resting_) {
            const double bend = bend_at(angle_, now);
            const double next = angle_ + (speed_ + 0.5 * bend * left) * left;
            if (next >= 0) {
                angle_ = next;
                const double bend_next = bend_at(angle_, a1);
                speed_ += 0.5 * (bend + bend_next) * left;
                note_energy();
                result_.overturns = angle_ >= std::numbers::pi / 2;
                return;
            }
            // When it comes down: the first root of angle + speed t + bend t^2 / 2.
            const double root = std::sqrt(std::max(0.0, speed_ * speed_ - 2 * bend * angle_));
            const double until = speed_ > 0   ? (speed_ + root) / -bend
                                 : angle_ > 0 ? 2 * angle_ / (root - speed_)
                                              : 0;
            speed_ = kept_[side_] * root;
            side_ = 1 - side_;
            angle_ = 0;
            now += (a1 - now) * std::min(1.0, until / left);
            left -= until;
            note_energy();
            // A free swing goes up and down again within 2 speed / p^2 sin(alpha).
            resting_ = 2 * speed_ <= longest_rest * fastest_p() * edge_[side_].sin_alpha;
        }
    }

  private:
    struct Edge {
        double alpha = 0, sin_alpha = 0, radius = 0, p2 = 0;
        double inertia = 0;  // about the edge, per kilogram
    };
    static Edge edge(const Profile& body, double base) {
        Edge e;
        e.alpha = std::atan2(base, body.height_m);
        e.sin_alpha = std::sin(e.alpha);
        e.radius = std::hypot(base, body.height_m);
        e.inertia = body.gyration_m * body.gyration_m + e.radius * e.radius;
        e.p2 = gravity * e.radius / e.inertia;
        return e;
    }
    static double kept(const Profile& body, double from, double to) {
        const double common = body.gyration_m * body.gyration_m + body.height_m * body.height_m;
        return std::max(0.0, (common - from * to) / (common + to * to));
    }
    double threshold(double base, bool rocks) const {
        return rocks ? gravity * base / height_ : INFINITY;
    }
    // Angular acceleration at an angle; keeps how high the centre of mass is then.
    double bend_at(double angle, double acceleration) {
        const Edge& e = edge_[side_];
        const double under = e.alpha - angle;
        const double c = std::cos(under), s = std::sin(under);
        rise_ = e.radius * c - height_;
        return e.p2 * ((side_ == 0 ? acceleration : -acceleration) / gravity * c - s);
    }
    // After bend_at() of the present angle.
    void note_energy() {
        const double potential = angle_ > 0 ? gravity * rise_ : 0;
        result_.energy_J_kg =
            std::max(result_.energy_J_kg, potential + 0.5 * edge_[side_].inertia * speed_ * speed_);
    }

    double height_;
    Edge edge_[2];      // ahead, behind
    double kept_[2];    // of the speed, when it comes down from that edge
    double starts_[2];  // accelerations at which it leaves the ground
    bool resting_ = true;
    int side_ = 0;
    double angle_ = 0, speed_ = 0, rise_ = 0;
    Rocking result_;
};

}  // namespace

Rocking rock(const Profile& body, const Accelerogram& record, double friction, double step) {
    Rocker rocker(body, friction);
    const double least = rocker.least_start(), p = rocker.fastest_p();
    if (!(record.peak_m_s2() > least)) return {};
    const auto parts = static_cast<unsigned>(std::max(1.0, std::ceil(record.step_s * p / step)));
    const double seconds = record.step_s / parts;
    for (std::size_t n = 0; n + 1 < record.m_s2.size(); ++n) {
        const double from = record.m_s2[n], change = (record.m_s2[n + 1] - from) / parts;
        if (rocker.rests() && std::max(std::fabs(from), std::fabs(record.m_s2[n + 1])) <= least)
            continue;
        for (unsigned part = 0; part < parts; ++part) {
            rocker.step(from + change * part, from + change * (part + 1), seconds);
            if (rocker.result().overturns) return rocker.result();
        }
    }
    for (double after = 0; after < longest_after && !rocker.rests() && !rocker.result().overturns;
         after += seconds * p)
        rocker.step(0, 0, seconds);
    return rocker.result();
}

Sliding slide(const Profile& body, const Accelerogram& record, double friction) {
    const double limit = friction * gravity;
    const bool ahead = !body.rocks_ahead(friction), behind = !body.rocks_behind(friction);
    Sliding out;
    double place = 0, speed = 0;
    for (std::size_t n = 0; n + 1 < record.m_s2.size(); ++n) {
        const double from = record.m_s2[n], to = record.m_s2[n + 1];
        const double slope = (to - from) / record.step_s;
        double at = 0;  // of the step, seconds
        while (at < record.step_s) {
            double now = from + slope * at;
            double way = speed > 0 ? 1 : -1;
            if (speed == 0) {
                if (now > limit && ahead) {
                    way = 1;
                } else if (-now > limit && behind) {
                    way = -1;
                } else if ((to > limit && ahead) || (-to > limit && behind)) {
                    way = to > 0 ? 1 : -1;
                    at = (way * limit - from) / slope;
                    now = way * limit;
                } else {
                    break;
                }
            }
            // speed + excess t + slope t^2 / 2 comes to 0 at `stops`, or not within this step.
            const double excess = now - way * limit, left = record.step_s - at;
            double stops = INFINITY;
            if (speed == 0) {
                if (slope * excess < 0) stops = -2 * excess / slope;
            } else {
                const double square = excess * excess - 2 * slope * speed;
                if (square >= 0) {
                    // The first root above 0, without cancellation.
                    const double q = -(excess + std::copysign(std::sqrt(square), excess));
                    for (const double root :
                         {slope != 0 ? q / slope : INFINITY, q != 0 ? 2 * speed / q : INFINITY}) {
                        if (root > 0) stops = std::min(stops, root);
                    }
                }
            }
            const double t = std::min(stops, left);
            place += (speed + (excess / 2 + slope * t / 6) * t) * t;
            speed = stops <= left ? 0 : speed + (excess + slope * t / 2) * t;
            out.ahead_m = std::max(out.ahead_m, place);
            out.behind_m = std::max(out.behind_m, -place);
            if (stops > left) break;
            at += t;
        }
    }
    if (speed != 0) place += limit > 0 ? speed * std::fabs(speed) / (2 * limit) : speed * INFINITY;
    out.ahead_m = std::max(out.ahead_m, place);
    out.behind_m = std::max(out.behind_m, -place);
    return out;
}

}  // namespace topple::safety
