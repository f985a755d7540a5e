// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "objects/object_stage.h"
#include "physics/fall_sweep.h"
#include "safety/fall_zone.h"
#include "solids/solid_parts.h"

namespace topple {

// What an object does on the easiest way out of its pose on which it comes to rest lower: where its
// centre of mass then is, at its first landing, what it sweeps until then, and the energy that it
// has there. Grid frame.
struct Landing {
    physics::Swept swept;
    double drop_m = 0;  // beyond where its support ends
    // Where no way takes less, the same; else where it comes to lean on what does not give way
    // (objects/stops.h) on the easiest one, which releases nothing.
    physics::Swept easiest;
    bool on_easiest = true;
    bool for_good = false;  // what stops it on the easiest way does not give way
    // What it has given up since the top of the barrier, with the lowest push over it.
    double hits_J = 0;
    safety::FallZone zone;
    std::vector<std::int32_t> takes_along;  // objects, ascending
};

// By object. Over an edge an object lands about its own height away, as high as its centre was
// beside the edge, unless it meets something before that does not go along with it; off a support's
// end by its height beyond it. What does not stay on its support tumbles, and reaches as far around
// its centre as it is long or high.
std::vector<Landing> landings(const SolidParts& parts, const ObjectStage& objects);

}  // namespace topple
