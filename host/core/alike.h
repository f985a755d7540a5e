// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "topple/input.h"

namespace topple {

inline constexpr double alike_sides = 0.15;

// Whether two boxes, each turned as it may be, are of one thing that was scanned twice.
// share: by which sides may differ, the shortest first.
inline bool alike_sizes(Vec3 a, Vec3 b, double share = alike_sides) {
    constexpr double at_least_m = 0.02;
    std::ranges::sort(a);
    std::ranges::sort(b);
    for (std::size_t n = 0; n < 3; ++n)
        if (std::abs(a[n] - b[n]) > at_least_m + share * std::max(a[n], b[n])) return false;
    return true;
}

}  // namespace topple
