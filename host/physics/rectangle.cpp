// SPDX-License-Identifier: MIT
#include "physics/rectangle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace topple::physics {

Rectangle smallest_rectangle(std::span<const std::array<double, 2>> polygon) {
    Rectangle best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < polygon.size(); ++n) {
        const auto &p = polygon[n], &q = polygon[(n + 1) % polygon.size()];
        const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
        if (!(length > 0)) continue;
        const std::array<double, 2> u{(q[0] - p[0]) / length, (q[1] - p[1]) / length};
        const std::array<std::array<double, 2>, 2> axes{u, {-u[1], u[0]}};
        std::array<double, 2> low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
        for (const auto& r : polygon) {
            for (std::size_t a = 0; a < 2; ++a) {
                const double at = r[0] * axes[a][0] + r[1] * axes[a][1];
                low[a] = std::min(low[a], at);
                high[a] = std::max(high[a], at);
            }
        }
        Rectangle around;
        around.axes = axes;
        for (std::size_t a = 0; a < 2; ++a) {
            around.half[a] = (high[a] - low[a]) / 2;
            for (std::size_t c = 0; c < 2; ++c)
                around.middle[c] += (high[a] + low[a]) / 2 * axes[a][c];
        }
        if (around.area() < least) {
            least = around.area();
            best = around;
        }
    }
    return best;
}

}  // namespace topple::physics
