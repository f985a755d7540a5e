// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/boundary_cells.h"
#include "core/solid_cells.h"
#include "physics/bodies.h"

// How well masses and centres of mass are known, by linear propagation: each piece of surface may
// lie a little farther out or in, all of it together, and independently of the others.
namespace topple::physics {

// One standard error of where a piece of a primitive's surface lies, as the volume that it adds.
struct VolumeError {
    std::int32_t primitive = -1;
    // What the volume is taken from: the primitive that it borders on there; -1: from none.
    std::int32_t from = -1;
    double volume_m3 = 0;
    Vec3 center{};  // of the piece, metres, grid frame
};

// A patch of surface adds its area times its standard error, which is the larger the thinner the
// solid is beside a voxel; a side of a solid that nobody saw is known to half a voxel; and of solid
// that nobody saw on both sides of (Basis column and after) a share is wrong. Sorted by primitive.
std::vector<VolumeError> volume_errors(const SolidCells& cells, const BoundaryCells& boundary);

// Standard errors of the body that some primitives are, sorted: what one of them takes from another
// changes nothing. densities: by primitive.
struct BodyError {
    double mass_kg = 0;
    Vec3 center_m{};  // along each axis, grid frame
};
BodyError body_error(const MassProperties& body, std::span<const std::int32_t> primitives,
                     std::span<const VolumeError> errors, std::span<const double> densities);

}  // namespace topple::physics
