// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

namespace topple::physics {

// In a plane: its middle, unit vectors along its sides, and half of each.
struct Rectangle {
    std::array<double, 2> middle{};
    std::array<std::array<double, 2>, 2> axes{{{1, 0}, {0, 1}}};
    std::array<double, 2> half{};
    double area() const { return 4 * half[0] * half[1]; }
};

// The smallest around a convex polygon: one of its sides lies along one of the polygon's (Freeman
// and Shapira, "Determining the minimum-area encasing rectangle for an arbitrary closed curve",
// 1975). Of fewer than three corners, or of corners on a line: without an area.
Rectangle smallest_rectangle(std::span<const std::array<double, 2>> polygon);

}  // namespace topple::physics
