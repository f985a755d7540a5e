// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/standing_hull.h"

// The pose landscape of a candidate, as its picture shows it.
namespace topple::physics {

// The pose as scanned is one of its poses, however
// shallow; others that are shallower than a voxel are parts of those that they lead to. Passes are
// those between two poses; those out of the pose as scanned are no higher than its `ways`
// (Stability::ways), which know how far its support reaches. Directions and corners are in the grid
// frame. No corners where it has none.
Landscape body_landscape(const StandingHull& hull, const Candidate& candidate,
                         const std::vector<TippingWay>& ways);

}  // namespace topple::physics
