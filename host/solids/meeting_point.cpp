// SPDX-License-Identifier: MIT
#include "solids/meeting_point.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/vectors.h"

namespace topple::solids {
namespace {

constexpr double farthest = 1.5;  // how far a vertex may go to where its patches meet, in voxels
constexpr int most_rounds = 6;
constexpr double settled_step = 1e-6;  // of a voxel: a step that ends the search

}  // namespace

Vec3 MeetingPoint::operator()(std::span<const std::uint32_t> of, const Vec3& base,
                              const Vec3& corner) const {
    if (of.size() == 1 && !patches_[of[0]].flat()) {
        Vec3 x = base;
        return settle(patches_[of[0]], x) && near(x, corner) ? x : base;
    }
    const bool flat = std::ranges::all_of(of, [&](std::uint32_t p) { return patches_[p].flat(); });
    const Spread first = spread(of, base);
    for (int rank = std::min<int>(3, static_cast<int>(of.size())); rank > 0; --rank) {
        Vec3 x = base;
        if (settle(of, rank, first, flat, x) && near(x, corner)) return x;
    }
    return base;
}

MeetingPoint::Spread MeetingPoint::spread(std::span<const std::uint32_t> of, const Vec3& x) const {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    for (const std::uint32_t p : of) {
        const Vec3 g = patches_[p].gradient(x);
        const double slope = length(g);
        if (!(slope > 0)) continue;
        const Eigen::Vector3d n = Eigen::Vector3d(g[0], g[1], g[2]) / slope;
        a += n * n.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(a);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

// Newton's method on one patch: whether it has a direction.
bool MeetingPoint::settle(const SurfacePatch& patch, Vec3& x) const {
    for (int round = 0; round < most_rounds; ++round) {
        const Vec3 g = patch.gradient(x);
        const double slope = length(g);
        if (!(slope > 0)) return false;
        const double step = patch.distance(x);
        for (std::size_t a = 0; a < 3; ++a) x[a] -= g[a] / slope * step;
        if (std::abs(step) < settled_step * h_) break;
    }
    return true;
}

// The same on several. Whether they determine so many directions. first: at x as it comes, and
// all along where they are flat.
bool MeetingPoint::settle(std::span<const std::uint32_t> of, int rank, const Spread& first,
                          bool flat, Vec3& x) const {
    constexpr double least = 0.02;  // eigenvalue, of the largest: creases above 16 degrees
    Spread later;
    for (int round = 0; round < most_rounds; ++round) {
        if (round > 0 && !flat) later = spread(of, x);
        const auto& [values, vectors] = round > 0 && !flat ? later : first;
        if (!(values[3 - rank] > least * values[2])) return false;
        Eigen::Vector3d b = Eigen::Vector3d::Zero();
        for (const std::uint32_t p : of) {
            const Vec3 g = patches_[p].gradient(x);
            const double slope = length(g);
            if (slope > 0) b += Eigen::Vector3d(g[0], g[1], g[2]) / slope * patches_[p].distance(x);
        }
        Eigen::Vector3d step = Eigen::Vector3d::Zero();
        for (int k = 0; k < rank; ++k) {
            const Eigen::Vector3d v = vectors.col(2 - k);
            step -= v * (v.dot(b) / values[2 - k]);
        }
        for (std::size_t k = 0; k < 3; ++k) x[k] += step[static_cast<int>(k)];
        if (step.norm() < settled_step * h_) break;
    }
    return true;
}

bool MeetingPoint::near(const Vec3& x, const Vec3& corner) const {
    for (std::size_t a = 0; a < 3; ++a)
        if (!(std::abs(x[a] - corner[a]) <= farthest * h_)) return false;
    return true;
}

}  // namespace topple::solids
