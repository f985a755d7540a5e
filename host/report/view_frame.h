// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "topple/scene.h"

namespace topple::report {

// The rows of the rotation from the input to the view: the scene's own frame where it has one with
// z up, else any with z up.
std::array<Vec3, 3> view_frame(const Scene& scene);

// A place or direction of the input in the view, and one of the view in the input.
Vec3 turned(const std::array<Vec3, 3>& view_from_input, double x, double y, double z);
Vec3 turned_back(const std::array<Vec3, 3>& view_from_input, const Vec3& p);

}  // namespace topple::report
