// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/ranked.h"

// Bounds that a few stray points can't stretch: a reading through a window, a mirror, a bad return.
namespace topple {

template <class T>
struct Bounds {
    std::array<T, 3> low{}, high{};  // both inclusive
    bool contains(T x, T y, T z) const {
        return x >= low[0] && x <= high[0] && y >= low[1] && y <= high[1] && z >= low[2] &&
               z <= high[2];
    }
};

// Lowest and highest of the values without the outer thousandth on each side, one at least; of
// fewer than 100 values, of all. `values` must not be empty; it is reordered.
template <class T>
std::array<T, 2> inner_range(std::vector<T>& values) {
    const std::size_t n = values.size();
    const std::size_t cut = n < 100 ? 0 : std::max<std::size_t>(1, n / 1000);
    const T lowest = ranked(values, cut);
    return {lowest, ranked(values, n - 1 - cut)};
}

// Bounds of all points; or, where these hold over four times as much space, the inner ranges per
// axis with a twentieth of the widest added on each side. Sides count as no shorter than `least`.
// There must be a point.
template <class T, class Values = std::span<const T>>
Bounds<T> scene_bounds(const std::array<Values, 3>& at, T least) {
    Bounds<T> all, inner;
    T widest{};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto [first, last] = std::minmax_element(at[a].begin(), at[a].end());
        all.low[a] = *first;
        all.high[a] = *last;
        std::vector<T> values(at[a].begin(), at[a].end());
        const auto [low, high] = inner_range(values);
        inner.low[a] = low;
        inner.high[a] = high;
        widest = std::max<T>(widest, high - low);
    }
    double all_space = 1, inner_space = 1;
    for (std::size_t a = 0; a < 3; ++a) {
        inner.low[a] = std::max<T>(all.low[a], inner.low[a] - widest / 20);
        inner.high[a] = std::min<T>(all.high[a], inner.high[a] + widest / 20);
        all_space *= static_cast<double>(std::max<T>(all.high[a] - all.low[a], least));
        inner_space *= static_cast<double>(std::max<T>(inner.high[a] - inner.low[a], least));
    }
    return all_space > 4 * inner_space ? inner : all;
}

}  // namespace topple
