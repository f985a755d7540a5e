// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/scene_bounds.h"
#include "tiles/blocks.h"

// What parses hold, as measured: in one piece by points and voxels, in blocks by thinned cells.
namespace topple {

// The stages after ingest, at their peak: per point cloud, surfels, regions and output, and per
// voxel of the scene's box.
inline std::uint64_t one_piece_bytes(double points, const Bounds<float>& bounds, double voxel_m) {
    double box = 1;
    for (std::size_t a = 0; a < 3; ++a) box *= (bounds.high[a] - bounds.low[a]) / voxel_m + 16;
    return static_cast<std::uint64_t>(400.0 * points + 40.0 * box);
}

// While a block with so many cells in its core is parsed: it sees its halo's, too.
inline double block_bytes(std::uint64_t cells) {
    constexpr double fixed = 60e6, a_cell = 450, seen = 1.75;
    return fixed + a_cell * seen * static_cast<double>(cells);
}

// From joining to the output, of all blocks' cells.
inline double whole_bytes(double cells) {
    constexpr double fixed = 100e6, a_cell = 73;
    return fixed + a_cell * cells;
}

inline std::uint64_t largest_block(const tiles::Layout& layout) {
    std::uint64_t cells = 0;
    for (const tiles::Block& b : layout.blocks) cells = std::max(cells, b.cells);
    return cells;
}

}  // namespace topple
