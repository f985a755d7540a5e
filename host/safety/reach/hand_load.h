// SPDX-License-Identifier: MIT
#pragma once

#include "safety/fields.h"

// What someone does to a thing that is in reach. Statics, as hands follow what gives way slowly,
// but for who falls against it.
namespace topple::safety {

// A load on an object, grid frame. It tips over the edge ahead where the moment beats its weight's,
//     F z > m g b,  or  of a climber  M > m g b,
// unless it slides before, F > mu m g with b > mu z: then it is taken along, arm_m at most, and
// falls where its support has ended by then.
struct HandLoad {
    Vec3 way{};           // level, unit: towards who pulls or climbs, away from who leans or falls
    double force_N = 0;   // level, at height_m above its base
    double height_m = 0;  //
    double climber_Nm = 0;   // M about the edge ahead, of who climbs, and of drawers; then force_N,
    double weight_N = 0;     // level, is 0 and this hangs M / weight_N before the edge
    double struck_kg = 0;    // of who falls: what meets the thing at height_m,
    double struck_m_s = 0;   // and how fast
    double half_base_m = 0;  // b, from below its centre of mass to the edge ahead
    double arm_m = 0;
};

// W, joules: the barrier that way where the load beats it, and else the share of it that the force
// is of what it would take; of what is taken along the share of its way, too.
// What is struck takes of that blow as much as stays with both.
double hand_work_J(const RiskObject& object, const HandLoad& load);
// What the object takes then of a blow, newton seconds.
double blow_impulse_Ns(const RiskObject& object, const HandLoad& load);

// M of who climbs a front that stands out over the edge ahead by out_m: 16 CFR 1261.4 (2022), of
// children who climbed drawers.
double climber_moment_Nm(double mass_kg, double out_m);

// Who trips and falls against a thing.
struct Fall {
    double mass_kg = 0, speed_m_s = 0;  // that meet it, level
};
// At height z above the floor, away_m from where a body of that height stands. It turns about its
// feet as an even rod does that walked on without them: I = m H^2 / 3 about the floor,
//     omega^2 = (3 v / 2 H)^2 + 3 g (1 - cos(theta)) / H,  tan(theta) = away / z,
// and meets the thing at omega z with I / z^2, m at most.
Fall fall_against(double body_height_m, double body_mass_kg, double walking_m_s, double z_m,
                  double away_m);

}  // namespace topple::safety
