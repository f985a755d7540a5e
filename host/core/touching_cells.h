// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/solid_cells.h"

namespace topple {

// Calls visit(m, n), m < n, for all cells that touch, by corners at least. Cells are sorted by
// (i, j, k).
template <class Visit>
void each_touching(const SolidCells& cells, const Visit& visit) {
    constexpr std::array<std::array<std::int32_t, 2>, 4> rows{
        {{0, -1}, {-1, -1}, {-1, 0}, {-1, 1}}};
    std::array<std::size_t, 4> first{};
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const Place at = place_of(cells, n);
        if (n > 0 && place_of(cells, n - 1) == Place{at[0], at[1], at[2] - 1}) visit(n - 1, n);
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const Place low{at[0] + rows[r][0], at[1] + rows[r][1], at[2] - 1};
            while (first[r] < n && place_of(cells, first[r]) < low) ++first[r];
            for (std::size_t m = first[r]; m < n; ++m) {
                const Place other = place_of(cells, m);
                if (other[0] != low[0] || other[1] != low[1] || other[2] > low[2] + 2) break;
                visit(m, n);
            }
        }
    }
}

// The same for cells of one column with up to `longest` between them that are none.
template <class Visit>
void each_across_gaps(const SolidCells& cells, std::int32_t longest, const Visit& visit) {
    for (std::size_t n = 1; n < cells.size(); ++n) {
        for (std::size_t m = n; m-- > 0;) {
            if (cells.i[m] != cells.i[n] || cells.j[m] != cells.j[n] ||
                cells.k[n] - cells.k[m] > longest + 1)
                break;
            visit(m, n);
        }
    }
}

}  // namespace topple
