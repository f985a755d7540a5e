#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

// The means of smooth.kernel in double precision, and how far off each may be.
struct Smoothed {
    std::vector<double> mean, bound;
};

inline Smoothed smooth_oracle(const std::vector<float>& height, const std::vector<float>& weight) {
    Smoothed out;
    for (std::size_t i = 0; i < height.size(); ++i) {
        const std::size_t last = height.size() - 1;
        double sum = 0, size = 0, weights = 0;
        for (const std::size_t k : {i - std::min<std::size_t>(i, 1), i, std::min(i + 1, last)}) {
            const double w = weight[k], h = height[k];
            sum += w * h;
            size += w * std::abs(h);
            weights += w;
        }
        out.mean.push_back(sum / weights);
        // At most three roundings touch a product in the sum, two a weight, and one the quotient.
        out.bound.push_back(6.001 * 0x1p-24 * size / weights);
    }
    return out;
}
