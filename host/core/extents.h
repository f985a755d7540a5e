// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace topple {

// The smallest box around points, along the axes.
template <class T>
struct Extents {
    std::array<T, 3> low{most, most, most}, high{least, least, least};

    void add(const std::array<T, 3>& p) {
        for (std::size_t a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], p[a]);
            high[a] = std::max(high[a], p[a]);
        }
    }
    bool empty() const { return low[0] > high[0]; }
    // Bit a of a corner's number: whether it lies high along axis a.
    std::array<std::array<T, 3>, 8> corners() const {
        std::array<std::array<T, 3>, 8> out;
        for (std::size_t n = 0; n < 8; ++n)
            for (std::size_t a = 0; a < 3; ++a) out[n][a] = (n >> a & 1) != 0 ? high[a] : low[a];
        return out;
    }

  private:
    static constexpr T most = std::numeric_limits<T>::max();
    static constexpr T least = std::numeric_limits<T>::lowest();
};

}  // namespace topple
