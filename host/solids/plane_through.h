// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <span>

#include "geometry/segmentation.h"

namespace topple::solids {

// The plane of least squares of distances through points; its normal is of either sign.
struct PlaneThrough {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), normal;
    // Sums of squared distances along the principal axes, rising: the first is what it leaves.
    Eigen::Vector3d squares;

    explicit PlaneThrough(std::span<const Eigen::Vector3d> points) {
        for (const auto& p : points) mean += p;
        mean /= static_cast<double>(points.size());
        Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
        for (const auto& p : points) spread += (p - mean) * (p - mean).transpose();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
        normal = solver.eigenvectors().col(0);
        squares = solver.eigenvalues();
    }
    geometry::AlgebraicModel model() const {
        geometry::AlgebraicModel out;
        out.origin = {mean.x(), mean.y(), mean.z()};
        out.coefficients = {0, normal.x(), normal.y(), normal.z(), 0, 0, 0, 0, 0, 0};
        return out;
    }
};

}  // namespace topple::solids
