// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// The one place that knows Qhull (Barber, Dobkin and Huhdanpaa, The Quickhull Algorithm for Convex
// Hulls, 1996).
namespace topple::physics {

struct ConvexHull {
    std::vector<std::uint32_t> vertices;  // numbers of the points that are corners, ascending
    // Corners of each face, counter-clockwise as seen from outside. Facets that are flat to within
    // rounding are one face.
    std::vector<std::vector<std::uint32_t>> faces;
};

// Nothing where the points, of any one unit, span no volume to within rounding. They must be
// finite. Throws Error(device) where memory runs out.
std::optional<ConvexHull> convex_hull(std::span<const std::array<double, 3>> points);

}  // namespace topple::physics
