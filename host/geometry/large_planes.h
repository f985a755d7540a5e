// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/vectors.h"
#include "geometry/manhattan_normals.h"

namespace topple::geometry {

// The planes that hold a good part of all surface: floors, walls, roofs, ramps.
struct LargePlanes {
    std::vector<bool> holds;  // by normal: whether it lies in one of them
    // How much of the scene lies before them, less what lies behind them, in the mean: 1 in a room,
    // -1 of a closed thing seen from outside, 0 of stairs, or of a floor with nothing on it.
    double enclosing = 0;
};

// directions: of normals, those that surfaces are large across.
LargePlanes find_large_planes(const Surfels& surfels, const WeightedNormals& normals,
                              const std::vector<Vec3>& directions);

}  // namespace topple::geometry
