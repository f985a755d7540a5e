// SPDX-License-Identifier: MIT
#pragma once

#include "core/thread_pool.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// Neighbours of a surfel in a plane whose cells are all occupied, and the most that a surfel has.
constexpr std::size_t plane_neighbours = 8, most_neighbours = 26;

// Sets the surfels' neighbours: the occupied ones of the 26 cells around each; where those are
// fewer than plane_neighbours, because the cells are finer than the points there, the nearest so
// many surfels, no further than `reach_m`. Mutual, and at most most_neighbours each: the shortest
// ties first.
void connect_surfels(Surfels& surfels, double reach_m, ThreadPool& threads);

}  // namespace topple::geometry
