// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace topple::oracle {

// x <- 0.7f / x, `rounds` times, in double precision. Each division adds a relative error of 2^-24
// at most and hands on that of its divisor.
inline void divide(const std::vector<float>& x, std::uint32_t rounds, std::vector<double>& out,
                   std::vector<double>& bound) {
    out.assign(x.begin(), x.end());
    bound.clear();
    const double numerator = 0.7f;
    for (double& value : out) {
        for (std::uint32_t n = 0; n < rounds; ++n) value = numerator / value;
        bound.push_back(1.001 * 0x1p-24 * rounds * std::abs(value));
    }
}

}  // namespace topple::oracle
