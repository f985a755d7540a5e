// SPDX-License-Identifier: MIT
#pragma once

#include "safety/fields.h"

// What someone does to a thing that is in reach. Statics: hands follow what gives way, slowly.
namespace topple::safety {

// A load on an object, grid frame. It tips over the edge ahead where the moment beats its weight's,
//     F z > m g b,  or  of a climber  M > m g b,
// unless it slides before, F > mu m g with b > mu z: then it is taken along, arm_m at most, and
// falls where its support has ended by then.
struct HandLoad {
    Vec3 way{};              // level, unit: towards who pulls or climbs, away from who leans
    double force_N = 0;      // level, at height_m above its base
    double height_m = 0;     //
    double climber_Nm = 0;   // M about the edge ahead, of who climbs; then force_N is 0
    double half_base_m = 0;  // b, from below its centre of mass to the edge ahead
    double arm_m = 0;
};

// W, joules: the barrier that way where the load beats it, and else the share of it that the force
// is of what it would take; of what is taken along the share of its way, too.
double hand_work_J(const RiskObject& object, const HandLoad& load, double friction);

// M of who climbs a front that stands out over the edge ahead by out_m: 16 CFR 1261.4 (2022), of
// children who climbed drawers.
double climber_moment_Nm(double mass_kg, double out_m);

}  // namespace topple::safety
