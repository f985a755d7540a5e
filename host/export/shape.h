// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <variant>

#include "export/convex_part.h"

// Parts that are simple solids: simulators collide these exactly and faster than meshes.
namespace topple::exports {

// How far the surface of a round solid may lie from that of the part which it stands for: a contact
// is not lost by that, and no overlap is made that moves anything.
inline constexpr double round_tolerance_m = 0.0005;
inline constexpr double box_tolerance_m = 1e-5;

struct Cylinder {
    Vec3 center{}, axis{};  // unit
    double radius_m = 0, half_m = 0;
};

struct Sphere {
    Vec3 center{};
    double radius_m = 0;
};

// What a part is; monostate: none of these. A round solid is the part to within round_tolerance_m,
// and to within a twentieth of its radius; a box, and the ends of a cylinder, to within
// box_tolerance_m. A box's axes are numbered so that they are turned against the world's as little
// as may be.
using Shape = std::variant<std::monostate, Box, Cylinder, Sphere>;
Shape shape_of(const ConvexPart& part);
inline bool is_mesh(const Shape& shape) {
    return std::holds_alternative<std::monostate>(shape);
}

// A right-handed frame whose third axis is this one.
std::array<Vec3, 3> frame_around(const Vec3& axis);

}  // namespace topple::exports
