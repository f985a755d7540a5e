// SPDX-License-Identifier: MIT
#include "points/formats/pose_rows.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace topple::io {
namespace {

// Of rotations that are written with three digits or more.
constexpr double tolerance = 0.01;

using Rows = std::span<const std::vector<double>>;

bool is_unit(std::span<const double> values) {
    const Eigen::Map<const Eigen::VectorXd> v(values.data(), std::ssize(values));
    return std::abs(v.norm() - 1) <= tolerance;
}

// Whether three rows begin with those of a rotation.
bool is_rotation(const double* a, const double* b, const double* c) {
    using Row = Eigen::Map<const Eigen::RowVector3d>;
    Eigen::Matrix3d m;
    m << Row(a), Row(b), Row(c);
    const Eigen::Matrix3d off = m * m.transpose() - Eigen::Matrix3d::Identity();
    return (off.array().abs() <= tolerance).all();
}

// Normals and something that is 0 beside them, as a curvature, are no quaternions; points in rows
// whose first column rises, of all such rows, are rare.
bool are_tum(Rows rows) {
    bool normals = true;
    for (std::size_t n = 0; n < rows.size(); ++n) {
        if (rows[n].size() != 8) return false;
        const auto q = std::span(rows[n]).subspan(4);
        if (!is_unit(q) || (n > 0 && !(rows[n][0] > rows[n - 1][0]))) return false;
        normals &= is_unit(q.first(3));
    }
    return !normals;
}

bool are_kitti(Rows rows) {
    return std::ranges::all_of(rows, [](const std::vector<double>& row) {
        return row.size() == 12 && is_rotation(&row[0], &row[4], &row[8]);
    });
}

bool are_matrices(Rows rows) {
    if (rows[0].size() == 3) rows = rows.subspan(1);
    if (rows.size() < 4) return false;
    const Rows m = rows.first(4);
    return std::ranges::all_of(m, [](const auto& row) { return row.size() == 4; }) &&
           is_rotation(m[0].data(), m[1].data(), m[2].data()) &&
           m[3] == std::vector<double>{0, 0, 0, 1};
}

}  // namespace

bool are_poses(Rows rows) {
    return !rows.empty() && (are_tum(rows) || are_kitti(rows) || are_matrices(rows));
}

}  // namespace topple::io
