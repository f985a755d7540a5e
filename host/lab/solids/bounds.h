// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "topple/input.h"

// Boxes along the axes, by their least and greatest corner.
namespace topple::scenes {

using Bounds = std::array<Vec3, 2>;

// What holds no place yet.
inline Bounds no_bounds() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {Vec3{infinity, infinity, infinity}, Vec3{-infinity, -infinity, -infinity}};
}

// Grows a box until it holds another, or a place.
inline void extend(Bounds& box, const Bounds& other) {
    for (std::size_t a = 0; a < 3; ++a) {
        box[0][a] = std::min(box[0][a], other[0][a]);
        box[1][a] = std::max(box[1][a], other[1][a]);
    }
}
inline void extend(Bounds& box, const Vec3& place) {
    extend(box, Bounds{place, place});
}

// Whether two boxes have a volume in common once they are `margin` further out.
inline bool overlap(const Bounds& p, const Bounds& q, double margin = 0) {
    for (std::size_t a = 0; a < 3; ++a) {
        if (p[0][a] >= q[1][a] + margin || q[0][a] >= p[1][a] + margin) return false;
    }
    return true;
}

}  // namespace topple::scenes
