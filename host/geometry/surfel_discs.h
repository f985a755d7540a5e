// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/thread_pool.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// The radius that each surfel must have as a disc in its plane, metres, so that the discs leave no
// gap where a surface goes on, however unevenly it was scanned: to the farthest corner of its
// Voronoi cell among its neighbours, which are laid down into its plane at their full distance, so
// that a face ends where another one begins. Corners farther off than gap_m are where the surface
// ends. At least what covers the square that a surfel stands for; all have that where gap_m is 0.
std::vector<float> covering_radii(const Surfels& surfels, double gap_m, ThreadPool& pool);

}  // namespace topple::geometry
