// SPDX-License-Identifier: MIT
#include "physics/overturning.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/tipping.h"

namespace topple::physics {

Overturning overturning(const Candidate& candidate, const BodyError& known,
                        const Stability& tipping, double top_m, double border_error_m,
                        double friction, double floor_m) {
    const Body& body = candidate.body;
    const double weight = body.mass_kg * gravity;
    const double height = body.center[2] - candidate.support_height_m;
    if (candidate.support_polygon.empty() || !(weight > 0) || !(height > 0)) return {};
    constexpr double degrees = 180 / std::numbers::pi;
    const double rise = tipping.barrier_J / weight;
    const double beside = edge_distance_m(rise, height);
    Overturning out;
    out.direction = tipping.easiest.direction;
    out.tilt_deg = std::atan(beside / height) * degrees;
    const double foot_error_m = std::hypot(border_error_m, foot_off_share * beside);
    out.tilt_error_deg = std::hypot(height * foot_error_m, beside * known.center_m[2]) /
                         (height * height + beside * beside) * degrees;
    const double arm = std::max(top_m - candidate.support_height_m, height);
    out.push_N = weight * beside / arm;
    out.push_error_N = std::hypot(weight * foot_error_m, gravity * known.mass_kg * beside) / arm;
    // What stands higher than a hand's height is reached for.
    constexpr double hand_m = 1;
    const double hand = floor_m + hand_m - candidate.support_height_m;
    out.hand_height_m = hand > 0 ? std::min(hand, arm) : height;
    out.hand_push_N = out.push_N * arm / out.hand_height_m;
    out.hand_push_error_N = out.push_error_N * arm / out.hand_height_m;
    out.slide_N = friction * weight;
    out.shake_g = std::min(beside / height, friction);
    return out;
}

double slope_error_share(const Overturning& overturning) {
    const double radians = std::numbers::pi / 180, tilt = overturning.tilt_deg * radians;
    const double share = overturning.tilt_error_deg * radians / (std::sin(tilt) * std::cos(tilt));
    return std::isfinite(share) ? share : 0;
}

}  // namespace topple::physics
