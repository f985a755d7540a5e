// SPDX-License-Identifier: MIT
#include "core/cell_columns.h"

#include <algorithm>

namespace topple {

CellColumns::CellColumns(const SolidCells& cells) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const bool new_row = c == 0 || cells.i[c] != cells.i[c - 1];
        if (!new_row && cells.j[c] == cells.j[c - 1]) continue;
        if (new_row) {
            row_i_.push_back(cells.i[c]);
            row_first_.push_back(column_j_.size());
        }
        column_j_.push_back(cells.j[c]);
        column_first_.push_back(c);
    }
    row_first_.push_back(column_j_.size());
    column_first_.push_back(cells.size());
}

std::size_t CellColumns::row_of(std::int32_t i) const {
    if (row_i_.empty() || i < row_i_.front() || i > row_i_.back()) return row_i_.size();
    // Rows of a room follow one another.
    const auto guess = static_cast<std::size_t>(std::int64_t{i} - row_i_.front());
    if (guess < row_i_.size() && row_i_[guess] == i) return guess;
    const auto found = std::ranges::lower_bound(row_i_, i);
    return *found == i ? static_cast<std::size_t>(found - row_i_.begin()) : row_i_.size();
}

std::pair<std::size_t, std::size_t> CellColumns::at(std::int32_t i, std::int32_t j) const {
    const std::size_t row = row_of(i);
    if (row == row_i_.size()) return {0, 0};
    const auto begin = column_j_.begin() + static_cast<std::ptrdiff_t>(row_first_[row]);
    const auto end = column_j_.begin() + static_cast<std::ptrdiff_t>(row_first_[row + 1]);
    const auto found = std::lower_bound(begin, end, j);
    if (found == end || *found != j) return {0, 0};
    const auto c = static_cast<std::size_t>(found - column_j_.begin());
    return {column_first_[c], column_first_[c + 1]};
}

}  // namespace topple
