// SPDX-License-Identifier: MIT
#include "core/cell_columns.h"

#include <algorithm>

namespace topple {

CellColumns::CellColumns(const SolidCells& cells) {
    const std::size_t n = cells.size();
    if (n == 0) return;
    lowest_i_ = cells.i.front();
    row_first_.assign(static_cast<std::size_t>(std::int64_t{cells.i.back()} - lowest_i_) + 2, 0);
    for (std::size_t c = 0; c < n; ++c) {
        if (c > 0 && cells.i[c] == cells.i[c - 1] && cells.j[c] == cells.j[c - 1]) continue;
        column_j_.push_back(cells.j[c]);
        column_first_.push_back(c);
        row_first_[static_cast<std::size_t>(std::int64_t{cells.i[c]} - lowest_i_) + 1] =
            column_j_.size();
    }
    column_first_.push_back(n);
    for (std::size_t r = 1; r < row_first_.size(); ++r) {
        row_first_[r] = std::max(row_first_[r], row_first_[r - 1]);
    }
}

std::pair<std::size_t, std::size_t> CellColumns::at(std::int32_t i, std::int32_t j) const {
    const std::int64_t row = std::int64_t{i} - lowest_i_;
    if (row < 0 || row + 1 >= static_cast<std::int64_t>(row_first_.size())) return {0, 0};
    const auto begin =
        column_j_.begin() + static_cast<std::ptrdiff_t>(row_first_[static_cast<std::size_t>(row)]);
    const auto end = column_j_.begin() +
                     static_cast<std::ptrdiff_t>(row_first_[static_cast<std::size_t>(row) + 1]);
    const auto found = std::lower_bound(begin, end, j);
    if (found == end || *found != j) return {0, 0};
    const auto c = static_cast<std::size_t>(found - column_j_.begin());
    return {column_first_[c], column_first_[c + 1]};
}

}  // namespace topple
