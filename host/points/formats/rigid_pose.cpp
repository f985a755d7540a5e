// SPDX-License-Identifier: MIT
#include "points/formats/rigid_pose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/room_measures.h"
#include "io/text.h"

namespace topple::io {
namespace {

// Matrices are printed with six digits or so; beyond this they are something else.
constexpr double rotation_tolerance = 1e-3;
// What arithmetic leaves of a rotation that was made so: that one stays as it is, so that making it
// rigid again changes no bit.
constexpr double rounding = 1e-14;

bool last_column_is_unit(const Mat4& m) {
    return std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1) <=
           rotation_tolerance;
}

}  // namespace

std::optional<std::string> position_fault(const Vec3& at_m) {
    for (const double value : at_m) {
        if (!(std::abs(value) <= farthest_m))
            return "position " + short_number(value) +
                   " is beyond the limit of 1e+06 m; use metres";
    }
    return std::nullopt;
}

std::optional<std::string> make_rigid(Mat4& m) {
    for (const double value : m)
        if (!std::isfinite(value)) return short_number(value) + " is not a finite number";
    const double off = std::abs(m[12]) + std::abs(m[13]) + std::abs(m[14]);
    if (off + std::abs(m[15] - 1) > rotation_tolerance)
        return std::string("the last row of a pose's matrix must be 0 0 0 1") +
               (last_column_is_unit(m) ? "; it looks transposed: matrices are row-major" : "");
    if (auto fault = position_fault({m[3], m[7], m[11]})) return fault;
    RowMajorPose pose(m.data());
    const Eigen::Matrix3d r = pose.topLeftCorner<3, 3>();
    const double error = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (error <= rotation_tolerance && r.determinant() < 0)
        return "the matrix is no rotation: it mirrors, its determinant is -1";
    if (!(error <= rotation_tolerance)) {
        return "the matrix is no rotation: its columns are off from orthonormal by " +
               short_number(error) + " (at most 0.001), its determinant is " +
               short_number(r.determinant());
    }
    if (error > rounding) {
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
        pose.topLeftCorner<3, 3>() = svd.matrixU() * svd.matrixV().transpose();
    }
    pose.row(3) << 0, 0, 0, 1;
    return std::nullopt;
}

std::optional<Vec3> mean_camera_up(std::span<const Mat4> poses) {
    Vec3 sum{};
    for (const Mat4& pose_of_camera : poses) {
        for (std::size_t row = 0; row < 3; ++row) sum[row] -= pose_of_camera[row * 4 + 1];
    }
    const double length = std::hypot(sum[0], sum[1], sum[2]);
    if (length < 1e-3 * static_cast<double>(poses.size())) return std::nullopt;
    return Vec3{sum[0] / length, sum[1] / length, sum[2] / length};
}

}  // namespace topple::io
