// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/scene_bounds.h"

// What parses hold and how long they take, as measured: in one piece by points and voxels, in
// blocks by thinned cells.
namespace topple {

// What decides the peak of a parse in one piece: its points, voxels of the surface and of the box
// around it, the ground there, what stands on it (scan_look.h), and whether a cloud is looked at
// from virtual views.
struct OnePiece {
    double points = 0, surface_voxels = 0, box_voxels = 0, ground_m2 = 0, patches_m = 0;
    bool views = true;

    // Voxels of the grid that are worked on: as many as the geometric mean of those of the surface
    // and those of the box.
    double grid_voxels() const { return std::sqrt(surface_voxels * box_voxels); }
};

// What people's walk takes grows no more on ground larger than this.
inline constexpr double walked_m2 = 4;

inline double one_piece_peak(const OnePiece& of) {
    constexpr double fixed = 61e6, of_views = 45e6, of_walks = 26e6, a_point = 167,
                     a_surface_voxel = 1040, a_voxel = 10.7, a_patch_m = 6.6e5;
    return fixed + (of.views ? of_views : 0) + of_walks * std::min(1.0, of.ground_m2 / walked_m2) +
           a_point * of.points + a_surface_voxel * of.surface_voxels + a_voxel * of.box_voxels +
           a_patch_m * of.patches_m;
}

// Seconds of the processor that the stages take together where estimate()'s probe takes 27 ms: a
// rate, of a voxel of the grid, and what every run takes.
inline double one_piece_seconds(const OnePiece& of) {
    constexpr double fixed = 0.3, voxel = 7e-6;
    return fixed + voxel * of.grid_voxels();
}

// While frames are fused: beside their cells, with readings that wait, of four million pixels at
// most; and with readings in so many cells of surfaces, whose sums are held twice.
inline double fusion_beside(double pixels) {
    constexpr double fixed = 61e6, waiting = 20, most_waiting = 4.2e6;
    return fixed + waiting * std::min(pixels, most_waiting);
}
inline double fusion_peak(double cells, double pixels) {
    constexpr double a_cell = 200;
    return fusion_beside(pixels) + a_cell * cells;
}

// What a parse in one piece is sure to keep to, by the bounds along the input's own axes.
inline std::uint64_t one_piece_bytes(double points, double surface_m2, const Bounds<float>& bounds,
                                     double voxel_m) {
    constexpr double sure = 2.3;
    double box = 1;
    for (std::size_t a = 0; a < 3; ++a) box *= (bounds.high[a] - bounds.low[a]) / voxel_m + 16;
    return static_cast<std::uint64_t>(
        sure * one_piece_peak({points, surface_m2 / (voxel_m * voxel_m), box, walked_m2, 0, true}));
}

// While a block with so many cells in its core is parsed: it sees its halo's, too.
inline double block_bytes(std::uint64_t cells) {
    constexpr double fixed = 195e6, a_cell = 300, seen = 1.75;
    return fixed + a_cell * seen * static_cast<double>(cells);
}

// From joining to the output, of all blocks' cells: what is found of all of them, and what is shown
// of a sample.
inline double whole_bytes(double cells) {
    constexpr double fixed = 130e6, a_cell = 73, sampled = 3e5, a_sampled_cell = 600;
    return fixed + a_cell * cells + a_sampled_cell * std::min(cells, sampled);
}

}  // namespace topple
