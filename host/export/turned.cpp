// SPDX-License-Identifier: MIT
#include "export/turned.h"

#include <Eigen/Geometry>
#include <cmath>

namespace topple::exports {
namespace {

Eigen::Matrix3d matrix_of(const Axes& axes) {
    Eigen::Matrix3d out;
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t row = 0; row < 3; ++row)
            out(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(a)) = axes[a][row];
    return out;
}

}  // namespace

std::array<double, 4> quaternion(const Axes& axes) {
    Eigen::Quaterniond q(matrix_of(axes));
    q.normalize();
    const double sign = q.w() < 0 ? -1 : 1;
    return {sign * q.w(), sign * q.x(), sign * q.y(), sign * q.z()};
}

Vec3 roll_pitch_yaw(const Axes& axes) {
    const Eigen::Matrix3d r = matrix_of(axes);
    // The roll is what is left once the yaw is undone: right, too, where the pitch is a right angle
    // and the yaw by itself says nothing.
    const double yaw = std::atan2(r(1, 0), r(0, 0));
    const double pitch = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
    const double s = std::sin(yaw), c = std::cos(yaw);
    const double roll = std::atan2(s * r(0, 2) - c * r(1, 2), c * r(1, 1) - s * r(0, 1));
    return {roll, pitch, yaw};
}

}  // namespace topple::exports
