// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::test {

// The columns that kernels voxel_normals and plane_mean read, of the cells `home`, by trying all
// cells. cells: sorted, each with its index.
template <class Cell>
std::vector<std::uint32_t> columns_by_trial(const std::vector<Cell>& cells,
                                            const std::vector<std::uint32_t>& home, int radius) {
    std::vector<std::uint32_t> out;
    for (int dx = -radius; dx <= radius; ++dx) {
        for (int dy = -radius; dy <= radius; ++dy) {
            for (const std::uint32_t h : home) {
                const std::array<int, 3>& at = cells[h].index;
                std::uint32_t first = 0, count = 0;
                for (std::size_t j = 0; j < cells.size(); ++j) {
                    const std::array<int, 3>& other = cells[j].index;
                    if (other[0] != at[0] + dx || other[1] != at[1] + dy ||
                        std::abs(other[2] - at[2]) > radius)
                        continue;
                    if (count++ == 0) first = static_cast<std::uint32_t>(j);
                }
                out.push_back(first | count << 28);
            }
        }
    }
    return out;
}

}  // namespace topple::test
