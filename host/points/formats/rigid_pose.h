// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>

#include "topple/input.h"

namespace topple::io {

// A Mat4 as Eigen's.
using RowMajorPose = Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>;

// What is wrong with a place, metres, if anything.
std::optional<std::string> position_fault(const Vec3& at_m);

// Makes the rotation of a pose, which is rounded wherever it comes from, the rotation next to it,
// and its last row 0 0 0 1. What is wrong with a pose that is none: its place, a rotation that is
// off by more than 1e-3, or values that are not finite. Twice is as once, bit for bit.
std::optional<std::string> make_rigid(Mat4& camera_to_world);

// Unit mean of the cameras' upward axes (-y), world frame: where people hold cameras level, up is
// near. Empty where the axes cancel out.
std::optional<Vec3> mean_camera_up(std::span<const Mat4> poses);

}  // namespace topple::io
