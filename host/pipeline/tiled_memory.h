// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

#include "tiles/blocks.h"

// What a parse in blocks holds, as measured on generated buildings. Thinned cells are its measure.
namespace topple {

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
