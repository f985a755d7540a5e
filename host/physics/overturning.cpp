// SPDX-License-Identifier: MIT
#include "physics/overturning.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/tipping.h"

namespace topple::physics {
namespace {

double foot_error(double border_error_m, double distance_m) {
    return std::hypot(border_error_m, foot_off_share * distance_m);
}

}  // namespace

TippingPush tipping_push(const MassProperties& body, const BodyError& known, double ahead_m,
                         double aside, double border_error_m, double arm_m) {
    const double weight = body.mass_kg * gravity;
    const double error_m = foot_error(border_error_m / aside, ahead_m);
    return {weight * ahead_m / arm_m,
            std::hypot(weight * error_m, gravity * known.mass_kg * ahead_m) / arm_m};
}

Overturning overturning(const Candidate& candidate, const BodyError& known,
                        const Stability& tipping, double top_m, double border_error_m,
                        const Friction& friction, double floor_m) {
    const MassProperties& body = candidate.body;
    const double weight = body.mass_kg * gravity;
    const double height = body.center[2] - candidate.support_height_m;
    if (candidate.support_polygon.empty() || !(weight > 0) || !(height > 0)) return {};
    constexpr double degrees = 180 / std::numbers::pi;
    const double rise = tipping.barrier_J / weight;
    const double beside = edge_distance_m(rise, height);
    Overturning out;
    out.direction = tipping.easiest.direction;
    out.tilt_deg = std::atan(beside / height) * degrees;
    const double foot_error_m = foot_error(border_error_m, beside);
    out.tilt_error_deg = std::hypot(height * foot_error_m, beside * known.center_m[2]) /
                         (height * height + beside * beside) * degrees;
    const double arm = std::max(top_m - candidate.support_height_m, height);
    const TippingPush push = tipping_push(body, known, beside, 1, border_error_m, arm);
    out.push_N = push.push_N;
    out.push_error_N = push.error_N;
    // What stands higher than a hand's height is reached for.
    constexpr double hand_m = 1;
    const double hand = floor_m + hand_m - candidate.support_height_m;
    out.hand_height_m = hand > 0 ? std::min(hand, arm) : height;
    out.hand_push_N = out.push_N * arm / out.hand_height_m;
    out.hand_push_error_N = out.push_error_N * arm / out.hand_height_m;
    out.slide_N = friction.coefficient * weight;
    out.slide_error_N =
        std::hypot(friction.error * weight, friction.coefficient * gravity * known.mass_kg);
    out.shake_g = std::min(beside / height, friction.coefficient);
    return out;
}

double slope_error_share(const Overturning& overturning) {
    const double radians = std::numbers::pi / 180, tilt = overturning.tilt_deg * radians;
    const double share = overturning.tilt_error_deg * radians / (std::sin(tilt) * std::cos(tilt));
    return std::isfinite(share) ? share : 0;
}

}  // namespace topple::physics
