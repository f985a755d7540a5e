// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <span>

// The horizontal directions that fields are sampled in.
namespace topple::safety {

inline constexpr unsigned direction_count = 16;

// Unit vector (x, y) of direction d: angle d * 22.5 degrees from +x towards +y. The axes are exact.
inline std::array<double, 2> direction(unsigned d) {
    const unsigned quarter = direction_count / 4;
    const double angle = (d % quarter) * 2 * std::numbers::pi / direction_count;
    const double c = std::cos(angle), s = d % quarter == 0 ? 0.0 : std::sin(angle);
    switch (d / quarter % 4) {
        case 0:
            return {c, s};
        case 1:
            return {0.0 - s, c};
        case 2:
            return {0.0 - c, 0.0 - s};
        default:
            return {s, 0.0 - c};
    }
}

// All of them.
inline std::span<const std::array<double, 2>> directions() {
    static const auto all = [] {
        std::array<std::array<double, 2>, direction_count> out{};
        for (unsigned d = 0; d < direction_count; ++d) out[d] = direction(d);
        return out;
    }();
    return all;
}

// The direction nearest to (x, y), not both 0; the lowest of equals.
inline unsigned nearest_direction(double x, double y) {
    unsigned best = 0;
    double most = -INFINITY;
    for (unsigned d = 0; d < direction_count; ++d) {
        const auto [dx, dy] = direction(d);
        const double along = x * dx + y * dy;
        if (along > most) {
            most = along;
            best = d;
        }
    }
    return best;
}

}  // namespace topple::safety
