// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/thread_pool.h"
#include "physics/bodies.h"
#include "safety/columns.h"
#include "safety/wind/wind_field.h"
#include "topple/space_field.h"

// Where in space the wind blows.
namespace topple::safety {

// Which of the layers asked for, k and above by bit, have nothing solid within `voxels` upwind of a
// point, given in voxels, in wind that blows along (dx, dy). Half-voxel steps; the first that
// counts lies outside of the point's own column.
std::uint64_t open_to_wind(const Columns& columns, double x, double y, std::int32_t k,
                           std::uint64_t layers, std::int32_t own_i, std::int32_t own_j, double dx,
                           double dy, double voxels);

// The share of gales that reach the middle of each cell in which nothing is solid, and their mean:
// of gales that blow along these unit vectors, one as likely as the other. Grid frame.
SpaceField wind_over_space(ThreadPool& threads, const SolidCells& solid, const Columns& columns,
                           std::span<const std::array<double, 2>> ways, const WindOptions& options);

}  // namespace topple::safety
