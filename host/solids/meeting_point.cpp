// SPDX-License-Identifier: MIT
#include "solids/meeting_point.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "solids/vectors.h"

namespace topple::solids {
namespace {

constexpr double farthest = 1.5;  // how far a vertex may go to where its patches meet, in voxels

}  // namespace

Vec3 MeetingPoint::operator()(std::span<const std::uint32_t> of, const Vec3& base,
                              const Vec3& corner) const {
    for (int rank = std::min<int>(3, static_cast<int>(of.size())); rank > 0; --rank) {
        Vec3 x = base;
        if (settle(of, rank, x) && near(x, corner)) return x;
    }
    return base;
}

// Newton's method. Whether the patches determine so many directions.
bool MeetingPoint::settle(std::span<const std::uint32_t> of, int rank, Vec3& x) const {
    constexpr int rounds = 6;
    constexpr double least = 0.02;    // eigenvalue, of the largest: creases above 16 degrees
    constexpr double settled = 1e-6;  // of a voxel
    for (int round = 0; round < rounds; ++round) {
        Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
        Eigen::Vector3d b = Eigen::Vector3d::Zero();
        for (const std::uint32_t p : of) {
            const Vec3 g = patches_[p].gradient(x);
            const double slope = length(g);
            if (!(slope > 0)) continue;
            const Eigen::Vector3d n = Eigen::Vector3d(g[0], g[1], g[2]) / slope;
            a += n * n.transpose();
            b += n * patches_[p].distance(x);
        }
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
        eigen.computeDirect(a);
        Eigen::Vector3d step = Eigen::Vector3d::Zero();
        const double largest = eigen.eigenvalues()[2];
        for (int k = 0; k < rank; ++k) {
            const double value = eigen.eigenvalues()[2 - k];
            if (!(value > least * largest)) return false;
            const Eigen::Vector3d v = eigen.eigenvectors().col(2 - k);
            step -= v * (v.dot(b) / value);
        }
        for (std::size_t k = 0; k < 3; ++k) x[k] += step[static_cast<int>(k)];
        if (step.norm() < settled * h_) break;
    }
    return true;
}

bool MeetingPoint::near(const Vec3& x, const Vec3& corner) const {
    for (std::size_t a = 0; a < 3; ++a)
        if (!(std::abs(x[a] - corner[a]) <= farthest * h_)) return false;
    return true;
}

}  // namespace topple::solids
