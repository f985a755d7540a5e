// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace topple::io {

// Tells files of cameras' poses, which are rows of numbers as well, from those of points: rows of
// TUM (t x y z qx qy qz qw, at times that rise), of KITTI (three rows [R | t]), and matrices of
// four rows, before each of which one of three may stand, as Open3D writes them. rows: the file's
// first ones; what is no number in them is NaN.
bool are_poses(std::span<const std::vector<double>> rows);

}  // namespace topple::io
