// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

// What the steps of splitting and merging agree on: what is one face. Limits are in the noise that
// was found, or in cells, so that they hold for any sensor and resolution.
namespace topple::geometry {

// Fewer surfels are no region: a patch of 3 by 3 cells less one. Set by hand.
inline constexpr std::uint32_t least_region = 8;

// Cosine of the angle (14 degrees) within which the directions of two faces are one: less than
// least_angle_deg (split.h), which a surfel may differ by from its face. Set by hand.
inline constexpr double parallel_cos = 0.97;

// Rounding of an edge, in cells: of the points of a cell that an edge passes half lie on either
// face, so that their mean is up to a quarter of the cell off each.
inline constexpr double rounding_cells = 0.25;

// How far from a region's model its own surface may lie, metres: twice its noise, which 19 of 20
// points keep to if that is Gaussian, and the rounding of edges.
inline double own_surface_m(double residual_m, double cell_m) {
    return 2 * residual_m + rounding_cells * cell_m;
}

}  // namespace topple::geometry
