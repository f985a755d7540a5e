// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "physics/bodies.h"

namespace topple::safety {

// Looks up solid cells by their place. Holds a reference to the cells.
class Columns {
  public:
    // cells: sorted by (i, j, k). Throws Error(input) where their bounds hold more than 2^28
    // columns.
    explicit Columns(const SolidCells& cells);

    double voxel_m() const { return cells_.voxel_m; }
    // Which of the cells (i, j, k) to (i, j, k + 63) are solid, the lowest in bit 0. Any indices
    // may be asked for.
    std::uint64_t solid(std::int64_t i, std::int64_t j, std::int64_t k) const;

  private:
    const SolidCells& cells_;
    // Lowest column and number of columns per axis; 0 columns without cells.
    std::int32_t i0_ = 0, j0_ = 0;
    std::int64_t ni_ = 0, nj_ = 0;
    std::vector<std::uint64_t> first_;  // where each column's cells start, by i, then j
    // Bit k - k0_ of each column's words, where they take no more than most_words; else empty, and
    // columns are searched.
    std::vector<std::uint64_t> bits_;
    std::int32_t k0_ = 0;
    std::int64_t nk_ = 0, words_ = 0;
};

}  // namespace topple::safety
