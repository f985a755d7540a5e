// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/solid_cells.h"

namespace topple {

// Cells by column, for cells sorted by (i, j, k). Takes no more memory than these, wherever they
// lie.
class CellColumns {
  public:
    CellColumns() = default;
    explicit CellColumns(const SolidCells& cells);
    // Cells of column (i, j): [first, last).
    std::pair<std::size_t, std::size_t> at(std::int32_t i, std::int32_t j) const;

  private:
    // The place of i among those that cells have; their number where none has it.
    std::size_t row_of(std::int32_t i) const;

    std::vector<std::int32_t> row_i_;     // ascending
    std::vector<std::size_t> row_first_;  // into the columns
    std::vector<std::int32_t> column_j_;
    std::vector<std::size_t> column_first_;  // into the cells
};

}  // namespace topple
