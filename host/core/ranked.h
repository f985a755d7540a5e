// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

// Values by their place in the order of all. Each reorders them.
namespace topple {

// The one that `rank` others come before.
template <class T>
T ranked(std::vector<T>& values, std::size_t rank) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

// The one that this share of the others come before, rounded down; 0 of none.
template <class T>
T quantile(std::vector<T>& values, double share) {
    if (values.empty()) return T{};
    return ranked(values, static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

// The one in the middle, of two the upper one; 0 of none.
template <class T>
T upper_median(std::vector<T>& values) {
    return values.empty() ? T{} : ranked(values, values.size() / 2);
}

}  // namespace topple
