// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "topple/input.h"

namespace topple {

// Of a voxel, or of a corner of voxels: (i, j, k).
using Place = std::array<std::int32_t, 3>;

constexpr Place sum_of(const Place& a, const Place& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
constexpr Place moved(Place at, std::size_t axis, std::int32_t by) {
    at[axis] += by;
    return at;
}
// Itself and those around it, in their order.
constexpr std::array<Place, 27> around(const Place& at) {
    std::array<Place, 27> out;
    for (std::int32_t n = 0; n < 27; ++n)
        out[n] = {at[0] + n / 9 - 1, at[1] + n / 3 % 3 - 1, at[2] + n % 3 - 1};
    return out;
}
// Of a voxel, in the grid frame.
constexpr Vec3 middle_of(const Place& at, double voxel_m) {
    return {(at[0] + 0.5) * voxel_m, (at[1] + 0.5) * voxel_m, (at[2] + 0.5) * voxel_m};
}

// Of the n-th of what has its places in arrays i, j and k.
constexpr Place place_of(const auto& all, std::size_t n) {
    return {all.i[n], all.j[n], all.k[n]};
}
// visit(array...) for each of the three arrays, the same one of all.
template <class Visit, class... All>
constexpr void each_place_array(const Visit& visit, All&... of) {
    visit(of.i...);
    visit(of.j...);
    visit(of.k...);
}
// Of those that are sorted by place, the first one at a place or beyond.
constexpr std::size_t first_at(const auto& all, const Place& at) {
    std::size_t low = 0, high = all.size();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        const bool before = place_of(all, middle) < at;
        (before ? low : high) = before ? middle + 1 : middle;
    }
    return low;
}

}  // namespace topple
