// SPDX-License-Identifier: MIT
#pragma once

#include "topple/input.h"

namespace topple::safety {

// The floor that a falling object sweeps: a level rectangle from where it stands to where the
// furthest of it comes to lie, as wide as it is, and the heights between which it moves. Metres,
// grid frame.
struct FallZone {
    Vec3 from{};           // its centre of mass as it stands
    Vec3 way{};            // level, unit; zero: it may go any way, and the zone is a disc
    double ahead_m = 0;    // along the way, or the disc's radius
    double left_m = 0;     // across it
    double right_m = 0;    // the other side
    double lowest_m = 0;   // height of what of it comes lowest
    double highest_m = 0;  // of its top as it stands
};

}  // namespace topple::safety
