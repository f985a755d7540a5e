// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace topple::oracle {

// Of element i the sum, modulo 2^32, of the table's words at the places that follow from the state
// i.
inline std::vector<std::uint32_t> gather(const std::vector<std::uint32_t>& table,
                                         std::uint32_t count, std::uint32_t rounds) {
    std::vector<std::uint32_t> sums;
    const std::uint64_t modulus = std::uint64_t{1} << 32, wide = modulus / table.size();
    for (std::uint64_t i = 0; i < count; ++i) {
        std::uint64_t state = i, sum = 0;
        for (std::uint32_t n = 0; n < rounds; ++n) {
            state = (state * 1664525 + 1013904223) % modulus;
            sum = (sum + table[state / wide]) % modulus;
        }
        sums.push_back(static_cast<std::uint32_t>(sum));
    }
    return sums;
}

}  // namespace topple::oracle
