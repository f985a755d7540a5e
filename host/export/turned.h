// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "topple/input.h"

// How a shape is turned against its body, as formats write it. axes: of a right-handed frame, unit.
namespace topple::exports {

using Axes = std::array<Vec3, 3>;

// w, x, y, z of the unit quaternion that turns the coordinates' axes to these; w >= 0.
std::array<double, 4> quaternion(const Axes& axes);

// The same as turns about the fixed axes x, y and z, in this order; radians.
Vec3 roll_pitch_yaw(const Axes& axes);

}  // namespace topple::exports
