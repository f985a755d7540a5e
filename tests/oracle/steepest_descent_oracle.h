// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::oracle {

// The end of the steepest way down from each direction, one step on: the least of it and its
// neighbours by (energy, number). neighbour: degree per direction.
inline std::vector<std::uint32_t> steepest_descent(const std::vector<float>& energy,
                                                   const std::vector<std::uint32_t>& neighbour,
                                                   std::size_t degree) {
    std::vector<std::uint32_t> down(energy.size());
    for (std::uint32_t v = 0; v < energy.size(); ++v) {
        std::pair<float, std::uint32_t> least{energy[v], v};
        for (std::size_t k = 0; k < degree; ++k) {
            const std::uint32_t w = neighbour[v * degree + k];
            least = std::min(least, {energy[w], w});
        }
        down[v] = least.second;
    }
    return down;
}

}  // namespace topple::oracle
