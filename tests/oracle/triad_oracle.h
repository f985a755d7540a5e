// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

namespace topple::oracle {

// dst = a + scale * b in double precision, and how far two roundings to float may be from it.
inline void triad(const std::vector<float>& a, const std::vector<float>& b, double scale,
                  std::vector<double>& dst, std::vector<double>& bound) {
    dst.resize(a.size());
    bound.resize(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double product = scale * b[i];
        dst[i] = a[i] + product;
        bound[i] = 1.001 * 0x1p-24 * (std::abs(product) + std::abs(dst[i]));
    }
}

}  // namespace topple::oracle
