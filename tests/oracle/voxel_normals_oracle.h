// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>

#include "standard.h"

namespace topple::oracle {

struct PlaneCell {
    std::array<int, 3> index{};
    double weight = 0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();    // from the cell's centre, cells
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();  // cells^2
    Eigen::Vector3d prior = Eigen::Vector3d::Zero();   // oriented normal or zero
};

struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double rms = 0, offset = 0;
    int used = 0;
    double gap =
        0;  // second smallest eigenvalue minus the smallest: how well the normal is defined
    double line = 0;  // second smallest over largest eigenvalue: how far the cells are from a line
};

// Kernel voxel_normals in plain double precision: all cells are tried, and Eigen solves the
// eigenproblem.
inline Plane fit_plane(const std::vector<PlaneCell>& cells, std::size_t home,
                       const Eigen::Vector3d& query, int radius, bool use_prior) {
    const PlaneCell& me = cells[home];
    const bool guided = use_prior && me.prior.squaredNorm() > 0;
    std::vector<double> weights;
    std::vector<Eigen::Vector3d> points;
    std::vector<const PlaneCell*> members;
    for (const PlaneCell& cell : cells) {
        const Eigen::Vector3d step(cell.index[0] - me.index[0], cell.index[1] - me.index[1],
                                   cell.index[2] - me.index[2]);
        if (step.cwiseAbs().maxCoeff() > radius) continue;
        const Eigen::Vector3d point = step + cell.mean - query;
        const double reach = radius + 0.5;
        double w =
            cell.weight * std::pow(std::max(0.0, 1 - point.squaredNorm() / (reach * reach)), 2);
        if (guided) w *= std::pow(std::max(0.0, me.prior.dot(cell.prior)), 2);
        if (w <= 0) continue;
        weights.push_back(w);
        points.push_back(point);
        members.push_back(&cell);
    }
    Plane plane;
    plane.used = static_cast<int>(weights.size());
    double total = 0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < weights.size(); ++i) {
        total += weights[i];
        mean += weights[i] * points[i];
    }
    if (!(total > 0)) return plane;
    mean /= total;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const Eigen::Vector3d d = points[i] - mean;
        covariance += weights[i] / total * (d * d.transpose() + members[i]->spread);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const Eigen::Vector3d values = solver.eigenvalues();
    plane.rms = std::sqrt(std::max(0.0, values[0]));
    plane.gap = values[1] - values[0];
    plane.line = values[2] > 0 ? values[1] / values[2] : 0;
    if (plane.used >= 3 && values[1] > 1e-4 && values[1] > 1e-3 * values[2]) {
        plane.normal = solver.eigenvectors().col(0);
        plane.offset = plane.normal.dot(mean);
    }
    return plane;
}

}  // namespace topple::oracle
