// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::oracle {

struct Block {
    double ahead = 0, behind = 0, height = 0, gyration = 0, friction = 0;
    double room_ahead = 1e30, room_behind = 1e30;
};
struct BlockMotion {
    double turned_ahead = 0, turned_behind = 0, slid_ahead = 0, slid_behind = 0;
    bool overturned() const { return std::max(turned_ahead, turned_behind) >= std::acos(0.0); }
};

// A block on shaking ground: its centre's acceleration, its turning and the force at its contact
// solve Newton's and Euler's equations, written out for the four unknowns (level and vertical
// acceleration of the centre over the ground per kilogram of force, angular acceleration, level
// force) of the corner that it stands on, by elimination; in steps of `step` seconds by Heun's
// method, events where they fall. phi > 0 leans ahead.
class BlockOracle {
  public:
    using Ground = std::function<std::array<double, 2>(double)>;  // level and upward, m/s^2

    BlockOracle(const Block& block, double gravity) : block_(block), gravity_(gravity) {}

    BlockMotion run(const Ground& ground, double seconds, double step) {
        for (double t = 0; t < seconds && !ended_; t += step) {
            const auto [a, u] = ground(t + step / 2);
            advance(a, std::max(gravity_ + u, 0.0), step);
        }
        return most_;
    }
    // Lets it go from a lean, at rest.
    void lean(double phi) { phi_ = phi; }
    double phi() const { return phi_; }
    double turning() const { return turning_; }

  private:
    struct Rates {
        double turning = 0, sliding = 0;
    };
    bool upright() const { return phi_ == 0 && turning_ == 0; }

    // Of the contact that slips to `way`, or sticks (0): {phi'', corner's acceleration, N, F}. The
    // corner is at (rx, rz) from the centre.
    std::array<double, 4> contact(double phi, double turning, double side, double a, double weight,
                                  double way) const {
        const double base = side > 0 ? block_.ahead : -block_.behind;
        const double rx = base * std::cos(phi) - block_.height * std::sin(phi);
        const double rz = -base * std::sin(phi) - block_.height * std::cos(phi);
        const double w2 = turning * turning, k2 = block_.gyration * block_.gyration;
        // Unknown: alpha, N, F.  k2 alpha = rz F - rx N.  The corner does not rise:
        //     -weight + N - rx alpha - rz w2 = 0.  It does not slip: a + F + rz alpha - rx w2 = 0;
        //     or F = -way mu N.
        double m[3][4] = {
            {k2, rx, -rz, 0}, {-rx, 1, 0, weight + rz * w2}, {rz, 0, 1, -a + rx * w2}};
        if (way != 0) {
            m[2][0] = 0;
            m[2][1] = way * block_.friction;
            m[2][3] = 0;
        }
        for (int c = 0; c < 3; ++c) {
            int best = c;
            for (int r = c + 1; r < 3; ++r)
                if (std::fabs(m[r][c]) > std::fabs(m[best][c])) best = r;
            std::swap(m[c], m[best]);
            for (int r = 0; r < 3; ++r) {
                if (r == c) continue;
                const double f = m[r][c] / m[c][c];
                for (int k = c; k < 4; ++k) m[r][k] -= f * m[c][k];
            }
        }
        const double alpha = m[0][3] / m[0][0], n = m[1][3] / m[1][1], f = m[2][3] / m[2][2];
        return {alpha, a + f + rz * alpha - rx * w2, n, f};
    }

    Rates rates(double phi, double turning, double sliding, double a, double weight) {
        const double grip = block_.friction * weight;
        if (phi == 0 && turning == 0) {
            const double force =
                sliding != 0 ? std::copysign(grip, sliding) : std::clamp(a, -grip, grip);
            const double base = force > 0 ? block_.ahead : block_.behind;
            if (std::fabs(force) * block_.height <= weight * base) return {0, a - force};
            side_ = force > 0 ? 1 : -1;
        }
        if (sliding == 0) {
            const auto [alpha, corner, n, f] = contact(phi, turning, side_, a, weight, 0);
            if (std::fabs(f) <= block_.friction * n) return {alpha, 0};
            const double way = f < 0 ? 1 : -1;
            const auto slips = contact(phi, turning, side_, a, weight, way);
            return {slips[0], slips[1]};
        }
        const auto slips = contact(phi, turning, side_, a, weight, sliding > 0 ? 1 : -1);
        return {slips[0], slips[1]};
    }

    void advance(double a, double weight, double step) {
        const Rates k1 = rates(phi_, turning_, sliding_, a, weight);
        const double turning_1 = turning_ + step * k1.turning;
        const double sliding_1 = stopped(sliding_, sliding_ + step * k1.sliding);
        Rates k2 = k1;
        const double phi_1 = phi_ + step * turning_;
        if (turning_1 != 0 && phi_1 * side_ > 0) k2 = rates(phi_1, turning_1, sliding_1, a, weight);
        const double next = turning_ + step / 2 * (k1.turning + k2.turning);
        const double slide = stopped(sliding_, sliding_ + step / 2 * (k1.sliding + k2.sliding));
        place_ += step / 2 * (sliding_ + slide);
        sliding_ = slide;
        phi_ += step / 2 * (turning_ + next);
        turning_ = next;
        if (phi_ * side_ < 0) land(weight, step);
        if (side_ > 0) {
            most_.turned_ahead = std::max(most_.turned_ahead, phi_);
        } else {
            most_.turned_behind = std::max(most_.turned_behind, -phi_);
        }
        most_.slid_ahead = std::max(most_.slid_ahead, place_);
        most_.slid_behind = std::max(most_.slid_behind, -place_);
        ended_ = most_.overturned() || place_ >= block_.room_ahead || -place_ >= block_.room_behind;
    }
    static double stopped(double before, double after) { return before * after < 0 ? 0 : after; }

    // The momentum about the corner that strikes is kept: of the turning about the centre, k2 w,
    // and of the centre that moves at right angles to the other corner's arm.
    void land(double weight, double step) {
        const double k2 = block_.gyration * block_.gyration, h = block_.height;
        const double from = side_ > 0 ? block_.ahead : -block_.behind;
        const double to = side_ > 0 ? -block_.behind : block_.ahead;
        const double before = k2 + h * h + from * to, after = k2 + h * h + to * to;
        turning_ = std::max(0.0, before / after) * turning_;
        side_ = -side_;
        phi_ = 0;
        // What would be up again within this step is at rest.
        if (std::fabs(turning_) < step / 2 * weight * std::fabs(to) / after) turning_ = 0;
    }

    Block block_;
    double gravity_;
    double side_ = 1, phi_ = 0, turning_ = 0, sliding_ = 0, place_ = 0;
    bool ended_ = false;
    BlockMotion most_;
};

}  // namespace topple::oracle
