// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>

#include "geometry/segmentation.h"

// Fitting implicit algebraic models by the three-layer method (paper, 2.1.1; Blane et al. 2000):
// the points keep f = 0, copies moved along their normals by +-offset keep f = +-offset, which
// fixes the sign (outside is where the normals point) and the scale (|f| is about the distance in
// metres).
namespace topple::geometry {

// Sums that a plane's fit needs, kept while a region grows. `shift` is the first point.
struct PlaneMoments {
    std::uint64_t count = 0;
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
    Eigen::Vector3d normal_sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d normal_outer = Eigen::Matrix3d::Zero();
    void add(const Eigen::Vector3d& p, const Eigen::Vector3d& n);
};

// Degree 1, unit gradient. offset_m: the layers' distance.
AlgebraicModel fit_plane(const PlaneMoments& moments, double offset_m);

// Degree 2. points and normals have equal length; unit normals or zero.
AlgebraicModel fit_quadric(std::span<const Eigen::Vector3d> points,
                           std::span<const Eigen::Vector3d> normals, double offset_m);

Eigen::Vector3d gradient(const AlgebraicModel& model, const Eigen::Vector3d& p);

// Signed distance to first order, f / |grad f|, metres; negative inside.
double distance(const AlgebraicModel& model, const Eigen::Vector3d& p);

}  // namespace topple::geometry
