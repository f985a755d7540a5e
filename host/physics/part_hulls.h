// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/boundary_cells.h"
#include "core/solid_cells.h"
#include "core/thread_pool.h"

namespace topple::physics {

// Corners of the convex hull of each part, metres, grid frame; none of those that are left out.
struct PartHulls {
    std::vector<std::vector<Vec3>> corners;
    double resolution_m = 0;  // to which they are known
};

// Of the primitives that `wanted` names. Whole cells count with their corners, those of the
// boundary with what is solid of them.
PartHulls part_hulls(const SolidCells& cells, const BoundaryCells& boundary,
                     const std::vector<bool>& wanted, ThreadPool& threads);

// The vertices of the convex hull of voxel corners, for each primitive, in voxels. Corners that lie
// inside the hull of their own i-slice are dropped exactly first; Qhull does the rest.
std::vector<std::vector<std::array<std::int32_t, 3>>> voxel_hulls(const SolidCells& cells,
                                                                  std::int32_t primitives);

}  // namespace topple::physics
