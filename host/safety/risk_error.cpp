// SPDX-License-Identifier: MIT
#include "safety/risk_error.h"

#include <algorithm>
#include <cmath>

#include "physics/landscape.h"
#include "physics/tipping.h"

namespace topple::safety {
namespace {

// From under the centre of mass to the border of the support that makes such a barrier.
double border_m(const RiskObject& object, double barrier_J) {
    const double weight = object.mass_kg * physics::gravity;
    const double rise = weight > 0 ? barrier_J / weight : 0;
    const double height = object.center ? (*object.center)[2] - object.base_m : 0;
    return physics::edge_distance_m(rise, std::max(height, 0.0));
}

RiskObject at_end(const RiskObject& object, double errors) {
    RiskObject out = object;
    const double measured = std::max(object.barrier_J, 0.0);
    const double there = std::max(0.0, measured + errors * object.barrier_error_J);
    if (!std::isfinite(there)) return out;
    out.root_shift = std::sqrt(there) - std::sqrt(measured);
    // Friction's work goes with the way to where the support ends.
    out.border_shift_m = object.slides && measured > 0
                             ? object.slide_distance_m * (there / measured - 1)
                             : border_m(object, there) - border_m(object, measured);
    return out;
}

}  // namespace

std::vector<RiskObject> at_end(std::span<const RiskObject> objects, double errors) {
    std::vector<RiskObject> out;
    for (const RiskObject& object : objects) out.push_back(at_end(object, errors));
    return out;
}

double risk_error_J(const Risk& risk, const RiskEnds& ends, double mass_error_share) {
    return std::hypot(risk.spread_J, (ends.lower.mean_J - ends.higher.mean_J) / 2,
                      risk.mean_J * mass_error_share);
}

}  // namespace topple::safety
