// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::oracle {

// Kernel group_stance in plain double precision. bound: what rounding may change.
inline void group_stance(const std::vector<std::vector<double>>& reach,
                         const std::vector<std::array<double, 2>>& direction,
                         const std::vector<std::vector<std::uint32_t>>& footings,
                         const std::vector<std::array<double, 2>>& center,
                         std::vector<double>& margin, std::vector<double>& bound) {
    for (std::size_t g = 0; g < footings.size(); ++g) {
        const auto [x, y] = center[g];
        double least = 3e38, largest = std::abs(x) + std::abs(y);
        for (std::size_t d = 0; d < direction.size() && !footings[g].empty(); ++d) {
            double most = -3e38;
            for (const std::uint32_t f : footings[g]) most = std::max(most, reach[f][d]);
            least = std::min(least, most - (direction[d][0] * x + direction[d][1] * y));
            largest = std::max(largest, std::abs(most));
        }
        margin.push_back(footings[g].empty() ? double{-3e38F} : least);
        bound.push_back(4 * 0x1p-24 * largest);
    }
}

}  // namespace topple::oracle
