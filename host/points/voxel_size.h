// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "core/scene_bounds.h"
#include "points/observation.h"
#include "topple/parse.h"

namespace topple {

// Voxels up to this many cells of the scan's resolution have gaps between points, which are closed
// by the surface's own neighbourhoods (geometry/surface_gaps.h).
inline constexpr double closing_cells = 1.75;

// Things in rooms are measured at this or finer.
inline constexpr double room_voxel_m = 0.02;

// Edge of a solid voxel, metres, whose surface has no gaps at a scan of this resolution: about two
// cells, rounded to a handy value.
double voxel_for_cell(double cell_m);

// Edge of the voxels of a scan that is parsed in one piece. Things in rooms are measured at 2 cm or
// finer, however far the points are apart; halls of more surface than 4 million such voxels, or of
// more than fits into max_memory_bytes (0: no limit), get larger ones, up to voxel_for_cell().
double voxel_for_scan(double cell_m, double surface_m2, const Bounds<float>& bounds, double points,
                      std::uint64_t max_memory_bytes);

// Of a parse: what its options say, else what its input has (a map), else by the above.
double voxel_for_input(const Observation& input, const ParseOptions& options);

}  // namespace topple
