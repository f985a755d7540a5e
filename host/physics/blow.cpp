// SPDX-License-Identifier: MIT
#include "physics/blow.h"

#include <algorithm>
#include <cmath>

#include "physics/infinity.h"
#include "physics/landscape.h"
#include "physics/tipping.h"

namespace topple::physics {
namespace {

// A blow below the centre that meets an edge askew throws the body back onto a corner, and more is
// lost when it comes down: so many times the energy in the mean of things struck in MuJoCo.
constexpr double on_a_corner = 1.25;

// Blows of more than so many times the least energy that could tip it are not looked at.
constexpr double most_speed = 32;

double square(double x) {
    return x * x;
}

// How the body begins to turn over an edge: at rate and slip (speed of the edge along the ground)
// per v. slip_sign: 1 if the edge slips the way that the body turns, -1 against it, 0: it holds.
struct Turning {
    double rate = 0, slip = 0;
    int slip_sign = 0;
};

// Over an edge `beside` the centre of mass, h above it; k is the radius of gyration.
class Pivot {
  public:
    Pivot(double beside_m, double height_m, double gyration_m, double friction)
        : b_(beside_m), h_(height_m), k2_(square(gyration_m)), mu_(friction) {
        radius_ = std::hypot(b_, h_);
        top_ = std::atan2(b_, h_);
        pinned2_ = k2_ + square(radius_);
        rise_J_kg_ = gravity * rise_over_edge_m(h_, b_);
    }
    // Square of the radius of gyration about the edge, where that holds.
    double pinned2() const { return pinned2_; }
    // The same with friction on an edge that slips: by the balance of turning about the centre,
    // k^2 w' = -(b - s mu h) N / M and N / M = g + b w'. Where that is not positive, friction jams
    // the edge (Painleve).
    double slipping2(int s) const { return k2_ + b_ * (b_ - s * mu_ * h_); }

    double least_speed(const Turning& start, double free_share) const {
        if (!(start.rate > 0) && !(b_ < mu_ * h_ && start.slip_sign > 0)) return infinity;
        if (start.slip_sign == 0) return std::sqrt(2 * rise_J_kg_ / pinned2_) / start.rate;
        double high = std::sqrt(2 * rise_J_kg_ / free_share);  // energy is not made
        if (falls(start, high)) return high;
        const double most = most_speed * high;
        double low = high;
        while (!falls(start, high *= 2)) {
            low = high;
            if (high >= most) return infinity;
        }
        for (int n = 0; n < 8; ++n) {
            const double between = 0.5 * (low + high);
            (falls(start, between) ? high : low) = between;
        }
        return high;
    }

  private:
    // While the edge slips, the angle q obeys q'' = l^2 (q - c) and the slip's speed falls by
    // mu g t + (mu b + s h)(w - w0): both are exact for small q.
    struct Slip {
        double l, c, rate, speed, mu_g, coupling;
        double angle(double e) const {
            return c - c * 0.5 * (e + 1 / e) + rate / l * 0.5 * (e - 1 / e);
        }
        double turn(double e) const { return rate * 0.5 * (e + 1 / e) - l * c * 0.5 * (e - 1 / e); }
        double left(double e) const {  // e = exp(l t)
            return speed - mu_g * std::log(e) / l - coupling * (turn(e) - rate);
        }
    };

    bool falls(const Turning& start, double v) const {
        const int s = start.slip_sign;
        // Flat bodies that friction holds back turn by angles that are not small, and fall back.
        const double stiff = std::max(h_ + s * mu_ * b_, 0.1 * h_);
        const Slip slip{std::sqrt(gravity * stiff / slipping2(s)),
                        (b_ - s * mu_ * h_) / stiff,
                        start.rate * v,
                        start.slip * v,
                        mu_ * gravity,
                        mu_ * b_ + s * h_};
        const bool passes = slip.rate >= slip.l * slip.c;
        if (!passes && slip.rate <= 0) return false;
        // Until it turns back, or is over.
        double end = passes
                         ? over(slip)
                         : std::sqrt((slip.l * slip.c + slip.rate) / (slip.l * slip.c - slip.rate));
        double low = 1, left_low = slip.speed, left = slip.left(end);
        if (left > 0) return passes;
        // Regula falsi, with the end that stays weighed less (Illinois).
        double at = end;
        for (int n = 0, side = 0; n < 30 && end - low > 1e-6 * end; ++n) {
            at = (left_low * end - left * low) / (left_low - left);
            const double value = slip.left(at);
            if (std::abs(value) < 1e-6 * slip.speed) break;
            if (value > 0) {
                low = at;
                left_low = value;
                if (side > 0) left /= 2;
                side = 1;
            } else {
                end = at;
                left = value;
                if (side < 0) left_low /= 2;
                side = -1;
            }
        }
        const double angle = slip.angle(at), turn = slip.turn(at);
        return angle >= top_ || goes_over(angle, turn, s);
    }
    // From the slip's end on. What slipped backwards may go on forwards: an edge that rests slows
    // the centre by h b / (k^2 + h^2) of what presses it, which friction has to do.
    bool goes_over(double angle, double turn, int s) const {
        if (turn < 0) return false;
        const double b = radius_ * std::sin(top_ - angle), h = radius_ * std::cos(top_ - angle);
        if (s < 0 && h * b > mu_ * (k2_ + h * h)) return slips_on(angle, turn);
        return has_energy(angle, turn);
    }
    bool has_energy(double angle, double turn) const {
        return pinned2_ * square(turn) / 2 >= gravity * radius_ * (1 - std::cos(top_ - angle));
    }
    // From an edge at rest that does not hold, forwards: until it is over, turns back, or the edge
    // comes to rest again. Steps of the equations of the kernel `rocking`.
    bool slips_on(double angle, double turn) const {
        const double step = 0.05 * std::sqrt(pinned2_ / (gravity * radius_));
        constexpr int most_steps = 400;
        double slip = 0;
        for (int n = 0; n < most_steps; ++n) {
            const double middle = angle + step / 2 * turn;
            const double b = radius_ * std::sin(top_ - middle),
                         h = radius_ * std::cos(top_ - middle);
            const double eased = std::max(k2_ + b * b - mu_ * h * b, k2_ / 16);
            const double pressed = std::max(gravity - h * square(turn), 0.0) / eased;  // N / M k^2
            const double bends = pressed * (mu_ * h - b);
            slip += step * (-mu_ * k2_ * pressed - h * bends - b * square(turn));
            angle += step * (turn + step / 2 * bends);
            turn += step * bends;
            if (angle >= top_) return true;
            if (slip <= 0) return has_energy(angle, turn);
            if (turn <= 0) return false;
        }
        return false;
    }
    // exp(l t) at which the angle is that of the edge's top.
    double over(const Slip& slip) const {
        constexpr double longest = 2e4;
        const double grows = (slip.rate / slip.l - slip.c) / 2,
                     decays = (slip.rate / slip.l + slip.c) / 2, left = top_ - slip.c;
        if (!(grows > 0)) return longest;
        return std::min(longest,
                        (left + std::sqrt(square(left) + 4 * grows * decays)) / (2 * grows));
    }

    double b_, h_, k2_, mu_;
    double radius_ = 0, top_ = 0, pinned2_ = 0, rise_J_kg_ = 0;
};

// Friction across an edge that slips forwards and along itself, too, `aside` per v: the share of it
// that the slip across the edge has of all slip. That slip itself depends on it.
double friction_across(const Upright& body, const Pivot& ahead, double z, double friction,
                       double aside) {
    const double b = body.ahead_m, h = body.height_m;
    if (aside <= 0 || ahead.pinned2() - z * h <= friction * z * b) return friction;
    double across = friction;
    for (int n = 0; n < 4; ++n) {
        const double turns = square(body.gyration_m) + b * (b - across * h);
        const double rate = turns > 0 ? (z - h) / turns : 0;
        const double slip = std::abs(1 - across * rate * b - rate * h);
        across = friction * slip / std::hypot(slip, aside);
    }
    return across;
}

// Of a blow above the centre: it presses the edge ahead down.
Turning struck_high(const Upright& body, const Pivot& ahead, double z, double friction) {
    const double b = body.ahead_m, h = body.height_m;
    // About an edge that holds w = z v / rho^2; friction suffices for that within its cone.
    const double needed = z * h - ahead.pinned2();
    const int s = needed < 0 ? 1 : -1;
    if (std::abs(needed) <= friction * z * b || ahead.slipping2(s) <= 0)
        return {z / ahead.pinned2(), 0, 0};
    const double rate = (z - h) / ahead.slipping2(s);
    return {rate, std::abs(1 - s * friction * rate * b - rate * h), s};
}

// Of a blow below the centre: it turns the body backwards, over an edge that slips forwards.
Turning struck_back(const Upright& body, const Pivot& behind, double z, double friction) {
    const double rate = (body.height_m - z) / behind.slipping2(-1);
    return {rate, 1 - friction * rate * body.behind_m + rate * body.height_m, -1};
}

// Of a blow below the centre: what is left when the body has come down from turning backwards.
Turning struck_low(const Upright& body, const Pivot& ahead, const Pivot& behind, double z,
                   double friction) {
    const double b = body.ahead_m, c = body.behind_m, h = body.height_m, mu = friction;
    const double k2 = square(body.gyration_m);
    const Turning start = struck_back(body, behind, z, friction);
    const double back = start.rate;
    double speed = 1 - mu * back * c;
    // Its turning slows by `slowing`, as long as the base slips, which it does less by `braking`.
    const double slowing = (c + mu * h) * gravity / behind.slipping2(-1);
    const double lifted = mu * (gravity - c * slowing);  // loss of speed meanwhile
    const double slips_s = start.slip / (lifted + h * slowing);
    const double down_s = 2 * back / slowing;
    if (slips_s < down_s) {
        // The edge behind comes to rest: it swings back about that, and on about the one ahead,
        // with the angular momentum about it (Housner 1963).
        const double turning = back - slowing * slips_s;
        const double angle = slips_s * (back + turning) / 2;
        const double lands =
            std::sqrt(square(turning) + 2 * gravity * c * angle / behind.pinned2());
        return {lands * (k2 + h * h - b * c) / ahead.pinned2(), 0, 0};
    }
    speed -= lifted * down_s;
    // It comes down as fast as it went up, and meets the ground with the edge ahead, which slips.
    const double jams = ahead.slipping2(1);
    const double rate = jams > 0 ? back * (k2 - c * (b - mu * h)) / jams : 0;
    const double slip = speed - mu * (rate * b + back * c) - rate * h;
    if (jams > 0 && !(rate > 0)) return {0, std::max(speed, 0.0), 1};
    if (jams > 0 && slip > 0) return {rate, slip, 1};
    return {(back * (k2 - b * c) + h * speed) / ahead.pinned2(), 0, 0};
}

}  // namespace

double free_share(const Upright& body, double z_m) {
    return 1 + square((z_m - body.height_m) / body.gyration_m);
}

double tips_ahead_m_s(const Upright& body, double z_m, double friction, double aside) {
    const Pivot ahead(body.ahead_m, body.height_m, body.gyration_m, friction);
    if (z_m >= body.height_m) {
        const double across = friction_across(body, ahead, z_m, friction, aside);
        const Pivot slipping(body.ahead_m, body.height_m, body.gyration_m, across);
        return slipping.least_speed(struck_high(body, slipping, z_m, across),
                                    free_share(body, z_m));
    }
    const Pivot behind(body.behind_m, body.height_m, body.gyration_m, friction);
    const Turning start = struck_low(body, ahead, behind, z_m, friction);
    const double more = aside > 0 ? std::sqrt(on_a_corner) : 1;
    return more * ahead.least_speed(start, free_share(body, z_m));
}

double tips_behind_m_s(const Upright& body, double z_m, double friction) {
    if (z_m >= body.height_m) {
        // Over the edge ahead it does not go, comes back, and goes on over the one behind: with
        // what energy the impact leaves of it (Housner 1963), which grows as that of the blow.
        const double both = square(body.gyration_m) + square(body.height_m);
        const double b = body.ahead_m, c = body.behind_m, kept = both - b * c;
        const double left = kept * kept / ((both + b * b) * (both + c * c));
        const double needed =
            rise_over_edge_m(body.height_m, c) / (left * rise_over_edge_m(body.height_m, b));
        if (!(kept > 0) || !(needed < 1)) return infinity;
        return tips_ahead_m_s(body, z_m, friction) * std::sqrt(needed);
    }
    const Pivot behind(body.behind_m, body.height_m, body.gyration_m, friction);
    return behind.least_speed(struck_back(body, behind, z_m, friction), free_share(body, z_m));
}

double sliding_share(const Upright& body, double z_m, double friction) {
    const bool high = z_m >= body.height_m;
    const double b = high ? body.ahead_m : body.behind_m, h = body.height_m;
    const Pivot edge(b, h, body.gyration_m, friction);
    const Turning start =
        high ? struck_high(body, edge, z_m, friction) : struck_back(body, edge, z_m, friction);
    // The base slips forwards with the edge ahead, and against the turning over the one behind.
    if (start.slip_sign != (high ? 1 : -1)) return 0;
    const int s = start.slip_sign;
    const double slowing = (b - s * friction * h) * gravity / edge.slipping2(s);
    const double braking = friction * (gravity - b * slowing) - s * h * slowing;
    if (!(braking > 0)) return 1;
    const double ends_s = start.slip / braking;
    if (slowing > 0 && ends_s >= 2 * start.rate / slowing) return 1;
    return std::min(1.0, std::sqrt(friction * gravity * start.slip * ends_s));
}

}  // namespace topple::physics
