// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// A disc's radius over the side of the square that it stands for: half the diagonal, and a little
// more, since surfels lie anywhere in their cells.
inline constexpr double radius_sides = 0.9;

// The radius that each surfel must have as a disc in its plane, metres, so that the discs leave no
// gap where a surface goes on, however unevenly it was scanned: to the farthest corner of its
// Voronoi cell among its neighbours, which are laid down into its plane at their full distance, so
// that a face ends where another one begins. Corners farther off than gap_m are where the surface
// ends. At least what covers the square that a surfel stands for; all have that where gap_m is 0.
std::vector<float> covering_radii(const Surfels& surfels, double gap_m, ThreadPool& pool);

// What of a disc is its surface: p of the plane normal . p >= least, and where the normal is 0 all.
struct DiscCut {
    std::array<float, 3> normal{};
    float least = 0;
};
// Where the faces of neighbours end a disc, in at most two directions: beyond the edge that two
// faces make there is nothing of either, and eyes would see it from behind.
using DiscCuts = std::array<DiscCut, 2>;
std::vector<DiscCuts> cuts_at_edges(const Surfels& surfels, std::span<const float> radii_m,
                                    ThreadPool& pool);

}  // namespace topple::geometry
