// SPDX-License-Identifier: MIT
#include "safety/largest_risk.h"

namespace topple::safety {

LargestRisk largest_risk(const Object& object) {
    LargestRisk out;
    for (const DisturbanceKind* kind : disturbance_kinds()) {
        const auto at = object.risk_J.find(kind->name);
        if (at != object.risk_J.end() && at->second > out.risk_J) out = {kind, at->second};
    }
    return out;
}

double released_J(const Object& object) {
    const auto [kind, risk_J] = largest_risk(object);
    if (kind == nullptr) return object.release_J;
    const auto chance = object.fall_chance.find(kind->name);
    return chance != object.fall_chance.end() && chance->second > 0 ? risk_J / chance->second
                                                                    : object.release_J;
}

}  // namespace topple::safety
