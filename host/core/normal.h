// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

// The standard normal distribution.
namespace topple {

inline double normal_density(double z) {
    return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
}
inline double normal_cdf(double z) {
    return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

}  // namespace topple
