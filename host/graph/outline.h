// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

namespace topple::graph {

// A point on or inside of the border of a contact, seen from above, and how well it is known: one
// standard error, metres.
struct BorderPoint {
    std::array<double, 2> at{};
    double error_m = 0;
};

// The convex hull of such points, counter-clockwise; its error is the mean over its corners.
struct Outline {
    std::vector<std::array<double, 2>> polygon;
    double error_m = 0;
};
Outline outline_of(std::vector<BorderPoint> points);

void add_points(const std::vector<std::array<double, 2>>& polygon, double error_m,
                std::vector<BorderPoint>& points);

}  // namespace topple::graph
