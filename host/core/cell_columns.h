// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/solid_cells.h"

namespace topple {

// Cells by column, for cells sorted by (i, j, k).
class CellColumns {
  public:
    explicit CellColumns(const SolidCells& cells);
    // Cells of column (i, j): [first, last).
    std::pair<std::size_t, std::size_t> at(std::int32_t i, std::int32_t j) const;

  private:
    std::int32_t lowest_i_ = 0;
    std::vector<std::size_t> row_first_;  // into the columns, per i
    std::vector<std::int32_t> column_j_;
    std::vector<std::size_t> column_first_;  // into the cells
};

}  // namespace topple
