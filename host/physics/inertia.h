// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/boundary_cells.h"
#include "core/solid_cells.h"
#include "physics/bodies.h"

namespace topple::physics {

// A symmetric 3 x 3 matrix: xx, yy, zz, xy, xz, yz.
using Symmetric = std::array<double, 6>;

// Second moments of volume of each of `count` primitives about the origin of the grid frame, m^5:
// the integrals of xx, yy, zz, xy, xz and yz over what of the cells is solid. A part of a voxel
// counts as one of the same middle, as wide as its share allows.
std::vector<Symmetric> second_moments(const SolidCells& cells, std::int32_t count,
                                      const BoundaryCells& boundary);

// Moments and products of inertia of each object about the centre of its volume, kg m^2, grid
// frame, at one density each. moments, bodies: by primitive; object_of_primitive: -1 for none.
std::vector<Symmetric> inertia_of_objects(std::span<const Symmetric> moments,
                                          std::span<const MassProperties> bodies,
                                          std::span<const std::int32_t> object_of_primitive,
                                          std::span<const double> density_kg_m3);

}  // namespace topple::physics
