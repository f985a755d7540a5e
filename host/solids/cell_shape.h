// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/boundary_cells.h"
#include "core/solid_cells.h"

// The outer form of solids, from the patches that bound them. Grid frame, metres.
namespace topple::solids {

// Adds points whose convex hull is about that of the solid part of a boundary voxel: corners of the
// voxel, where patches cross its edges, where two patches meet on one of its sides, and three
// within it. Where patches are curved, those of parts of the voxel.
void add_corners(const BoundaryCells& boundary, std::size_t n, double voxel_m,
                 std::vector<Vec3>& out);

// How well a voxel's own sides are known where no patch bounds it, in voxels: one standard error.
inline constexpr double voxel_error = 0.5;

struct UndersideCorner {
    Vec3 at{};
    double error_m = 0;    // seen from above: of the patches beside it
    bool bounded = false;  // by a patch from below, which tells its height
};
// Of the lowest voxel of a primitive in a column, the outline of its underside: corners of the
// patch that bounds it below, or of its lowest side; nothing where the primitive does not reach
// there. The voxel below comes first where the primitive goes on into it.
std::vector<UndersideCorner> underside_of(const BoundaryCells& boundary, std::int32_t i,
                                          std::int32_t j, std::int32_t k, std::int32_t primitive,
                                          double voxel_m);

// A column of voxels that a primitive reaches into although none of its cells is there: the lowest
// of its boundary voxels with anything solid.
struct BorderColumn {
    std::int32_t i, j, k, primitive;
};
// Sorted by (primitive, i, j).
std::vector<BorderColumn> border_columns(const SolidCells& cells, const BoundaryCells& boundary);

// The height of a primitive's surface over the middle of a column of which k is the highest voxel,
// metres: the patches may end it there, or one voxel above or below.
double top_of(const BoundaryCells& boundary, std::int32_t i, std::int32_t j, std::int32_t k,
              std::int32_t primitive, double voxel_m);

// To what the outer form of the solids is known: three times the noise of the typical patch that
// bounds them, no more than a voxel, which it is where nothing bounds them, and no less than a
// hundredth.
double form_error_m(const BoundaryCells& boundary, double voxel_m);

}  // namespace topple::solids
