// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "physics/hull_ways.h"
#include "physics/landscape.h"
#include "physics/part_hulls.h"

// The one hull of a candidate on which it turns, for its barriers and for the landscape that is
// drawn.
namespace topple::physics {

struct StandingHull {
    std::shared_ptr<const HullWays> ways;  // nothing where it has no corners
    double resolution_m = 0;               // to which its corners are known
};

// Whether its centre of mass lies inside of what holds it up.
bool is_held(const Candidate& candidate);

// Where a candidate stood and its footing holds it, or its hull would fall though its footing holds
// it, the hull is cut at the height of the support and as wide there as the footing: what reaches
// lower is noise, or hangs beside the end of the support. Else it is that of its parts' corners, or
// of these widened by half of their resolution and about the centre of mass, where they span no
// volume about that. Its start is the pose as scanned, or the bottom of the dent that holds it.
StandingHull standing_hull(const PartHulls& parts, const Candidate& candidate);

}  // namespace topple::physics
