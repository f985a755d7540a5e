// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::oracle {

using Matrix = std::vector<std::vector<double>>;

// Kernel dense_layer in plain double precision: y = w . (1, x), of rows x that are put together
// already; w has the biases first. bound: what rounding may change, by its usual analysis.
inline void dense_layer(const Matrix& x, const Matrix& w, bool rectified, const Matrix* added,
                        std::vector<double>& y, std::vector<double>& bound) {
    for (std::size_t row = 0; row < x.size(); ++row) {
        for (std::size_t out = 0; out < w[0].size(); ++out) {
            double sum = w[0][out], size = std::abs(sum);
            for (std::size_t k = 0; k < x[row].size(); ++k) {
                sum += x[row][k] * w[1 + k][out];
                size += std::abs(x[row][k] * w[1 + k][out]);
            }
            if (rectified) sum = std::max(sum, 0.0);
            if (added) {
                sum += (*added)[row][out];
                size += std::abs((*added)[row][out]);
            }
            y.push_back(sum);
            bound.push_back((static_cast<double>(x[row].size()) + 3) * 0x1p-24 * size);
        }
    }
}

// Kernel neighbour_pool: edges as pairs of nodes, a message to either end of each.
inline void neighbour_pool(std::size_t nodes, std::size_t width,
                           const std::vector<std::array<std::uint32_t, 2>>& edges,
                           const std::array<Matrix, 2>& message, std::vector<double>& y,
                           std::vector<double>& bound) {
    for (std::size_t node = 0; node < nodes; ++node) {
        std::vector<double> sum(width, 0), most(width, 0);
        double count = 0;
        for (std::size_t e = 0; e < edges.size(); ++e) {
            for (std::size_t side = 0; side < 2; ++side) {
                if (edges[e][side] != node) continue;
                ++count;
                for (std::size_t k = 0; k < width; ++k) {
                    sum[k] += message[side][e][k];
                    most[k] = std::max(most[k], message[side][e][k]);
                }
            }
        }
        for (const double s : sum) {
            y.push_back(s / std::max(count, 1.0));
            bound.push_back((count + 2) * 0x1p-24 * std::abs(s));
        }
        for (const double m : most) {
            y.push_back(m);
            bound.push_back(0);
        }
    }
}

}  // namespace topple::oracle
