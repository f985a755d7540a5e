// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/scene_bounds.h"
#include "tiles/blocks.h"

// What parses hold, as measured: in one piece by points and voxels, in blocks by thinned cells.
namespace topple {

// In one piece. The peak is where the surface is taken apart, or where solids are made; `views`: of
// a cloud, which is looked at from free places, and not of frames.
// Of the 192 random inputs of tests/estimates that it is fitted to 77 % come within 25 % of this,
// and none to more than 1.85 of it; a real scan of many noisy frames to 2.2.
inline double one_piece_peak(double points, double surface_m2, const Bounds<float>& bounds,
                             double voxel_m, bool views = true) {
    constexpr double fixed = 92e6, of_views = 17e6, a_point = 353, a_surface_voxel = 1670,
                     a_voxel = 3.7;
    double box = 1;
    for (std::size_t a = 0; a < 3; ++a) box *= (bounds.high[a] - bounds.low[a]) / voxel_m + 16;
    const double surface = surface_m2 / (voxel_m * voxel_m);
    return fixed + (views ? of_views : 0) +
           std::max(a_point * points, a_surface_voxel * surface + a_voxel * box);
}

// What a parse in one piece is sure to keep to.
inline std::uint64_t one_piece_bytes(double points, double surface_m2, const Bounds<float>& bounds,
                                     double voxel_m) {
    constexpr double sure = 2.3;
    return static_cast<std::uint64_t>(sure * one_piece_peak(points, surface_m2, bounds, voxel_m));
}

// While a block with so many cells in its core is parsed: it sees its halo's, too.
inline double block_bytes(std::uint64_t cells) {
    constexpr double fixed = 120e6, a_cell = 450, seen = 1.75;
    return fixed + a_cell * seen * static_cast<double>(cells);
}

// From joining to the output, of all blocks' cells: what is found of all of them, and what is shown
// of a sample.
inline double whole_bytes(double cells) {
    constexpr double fixed = 130e6, a_cell = 73, sampled = 3e5, a_sampled_cell = 600;
    return fixed + a_cell * cells + a_sampled_cell * std::min(cells, sampled);
}

inline std::uint64_t largest_block(const tiles::Layout& layout) {
    std::uint64_t cells = 0;
    for (const tiles::Block& b : layout.blocks) cells = std::max(cells, b.cells);
    return cells;
}

}  // namespace topple
