// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "topple/scene.h"

namespace topple::physics {

// The points without those that lie within a distance of one that comes before. Hulls of points of
// which some are all but the same have faces that are no planes.
std::vector<Vec3> merge_close_points(const std::vector<Vec3>& points, double tolerance_m);

}  // namespace topple::physics
