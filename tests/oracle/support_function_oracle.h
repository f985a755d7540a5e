// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::oracle {

// s(d) = min over points v of v . d for each direction, in double precision, and how far a float
// dot product of three terms may be from it: 3 roundings, each of at most the sum of the terms'
// sizes (Higham, Accuracy and Stability of Numerical Algorithms, 3.1).
inline void support_function(const std::vector<std::array<float, 3>>& points,
                             const std::vector<std::array<float, 3>>& directions,
                             std::vector<double>& s, std::vector<double>& bound) {
    s.assign(directions.size(), std::numeric_limits<double>::infinity());
    bound.assign(directions.size(), 0);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        for (const auto& v : points) {
            double dot = 0, size = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double term = double{v[axis]} * directions[i][axis];
                dot += term;
                size += std::abs(term);
            }
            s[i] = std::min(s[i], dot);
            bound[i] = std::max(bound[i], 3.001 * 0x1p-24 * size);
        }
    }
}

}  // namespace topple::oracle
