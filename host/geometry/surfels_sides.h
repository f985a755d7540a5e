// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/cell_grid.h"
#include "geometry/plane_fit.h"
#include "geometry/surfels_orient.h"
#include "topple/cloud_view.h"

namespace topple::geometry {

// Parts the cells that hold both sides of a wall thinner than themselves, as of a cup, in two, one
// after the other: together they would lie within the wall, and know one side of it. Whose sensor
// was on the other side of the cell's plane is of the other side of the wall, if it lies apart from
// the rest by more than these scatter. count: points per cell; of_point: cell of each point;
// planes: of each cell.
void part_sides(const CloudView& cloud, const SensorSides& sides, ThreadPool& threads,
                CellGrid& grid, std::vector<float>& count, std::vector<std::uint32_t>& of_point,
                PlaneFit& planes);

}  // namespace topple::geometry
