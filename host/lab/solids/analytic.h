// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "physics/bodies.h"
#include "topple/input.h"

// Single solids whose mass properties are known in closed form, as voxel cells: for tests of
// whatever works on cells.
namespace topple::scenes {

enum class Body {
    box,         // size: sides
    cylinder,    // axis z; size: diameter, -, height
    cone,        // base down, tip up; size: diameter of the base, -, height
    hemisphere,  // flat side down; size: diameter
    sphere,      // size: diameter
};

// The body's own origin is the middle of its underside (of its bounding box), z up; `turn`
// (row-major) and then `at` take it to the world.
struct AnalyticSolid {
    Body body = Body::box;
    Vec3 size{1, 1, 1};  // metres
    std::array<double, 9> turn{1, 0, 0, 0, 1, 0, 0, 0, 1};
    Vec3 at{};

    double volume() const;  // m^3, closed form
    Vec3 center() const;    // centre of mass in the world, closed form
    bool inside(const Vec3& world) const;
    std::array<Vec3, 2> bounds() const;  // of a box that holds it, world
};

// Appends the voxels whose centres lie inside the solid, as seen surface where one of the six
// neighbours' centres lies outside and else as completed. Keeps the cells sorted by (i, j, k); a
// voxel that is there already is left as it is. `cells.voxel_m` must be set. Throws Error(usage)
// where the solid would take more than 10^8 voxels' tests.
void append(SolidCells& cells, const AnalyticSolid& solid, std::int32_t primitive);

}  // namespace topple::scenes
