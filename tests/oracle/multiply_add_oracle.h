// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace topple::oracle {

// x <- 0.999f * x + 0.5f, `rounds` times, in double precision. A step's two roundings add at most
// 2^-24 of the product and of the sum, and each later step damps them by 0.999.
inline void multiply_add(const std::vector<float>& x, std::uint32_t rounds,
                         std::vector<double>& out, std::vector<double>& bound) {
    out.assign(x.begin(), x.end());
    bound.assign(x.size(), 0);
    const double factor = 0.999f;
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::uint32_t n = 0; n < rounds; ++n) {
            const double product = factor * out[i];
            out[i] = product + 0.5;
            bound[i] = factor * bound[i] +
                       1.001 * 0x1p-24 * (std::abs(product) + std::abs(out[i]) + 2 * bound[i]);
        }
    }
}

}  // namespace topple::oracle
