// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "report/drawing.h"

// The single drawings. For this folder.
namespace topple::report {

inline constexpr double width = 330;

Drawing draw_poses(const Scene& scene, const Object& object);
Drawing draw_tree(const Object& object);
Drawing draw_places(const Landscape::Places& places);
Drawing draw_curve(const Object& object);

std::string joules(double value);

// The least v.d of the corners v: minus the height of their centre above the plane with d up.
double lowest_of(const std::vector<Vec3>& corners, const Vec3& d);

// Which poses the pictures show, and the number that each has there, from 1; 0 for others: the one
// that it is in, and the deepest basins.
std::vector<int> numbers_of(const Landscape& landscape);

}  // namespace topple::report
