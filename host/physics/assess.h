// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/standing_hull.h"

// What one landscape and one footing say about a candidate.
namespace topple::physics {

// The barrier is the least of
//   - M g (sqrt(h^2 + m^2) - h) over the edges of the support polygon, m the distance of the centre
//     of mass to the edge's line, h its height above the support (exact for rigid tipping), and
//   - the lowest pass of the hull's landscape on a plane (paper, Eq. 4, Defs. 1 and 2).
// A centre of mass outside the polygon, or no polygon: barrier 0. The curve counts what the pose
// releases on a plane at the support's height, and the candidate's drops. Throws Error(usage) for
// drops that are not one for each edge.
Stability assess(const StandingHull& hull, const Candidate& candidate);

// Fills in what follows from the ways, of which there is one at least: all but its margin and the
// ways themselves. Climbs within alike_m are equal.
void weigh_ways(const std::vector<TippingWay>& ways, double weight_N, double alike_m,
                Stability& result);

}  // namespace topple::physics
