// SPDX-License-Identifier: MIT
#pragma once

#include "safety/disturbances.h"
#include "topple/scene.h"

namespace topple::safety {

// By what an object is at most risk, the first of equals in the kinds' order, and joules per event;
// null and 0 where nothing puts it at risk.
struct LargestRisk {
    const DisturbanceKind* kind = nullptr;
    double risk_J = 0;
};
LargestRisk largest_risk(const Object& object);

// Joules that it sets free on average when that comes true; where it has none, on the easiest way
// out of its place.
double released_J(const Object& object);

}  // namespace topple::safety
