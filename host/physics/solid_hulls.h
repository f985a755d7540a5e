// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/boundary_cells.h"
#include "core/solid_cells.h"
#include "core/thread_pool.h"

namespace topple::physics {

// Corners of the convex hull of each primitive that `wanted` names, metres, grid frame; the others
// have none. Whole cells count with their corners, those of the boundary with what is solid of
// them.
std::vector<std::vector<Vec3>> solid_hulls(const SolidCells& cells, const BoundaryCells& boundary,
                                           const std::vector<bool>& wanted, ThreadPool& threads);

}  // namespace topple::physics
