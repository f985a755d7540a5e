// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "core/boundary_cells.h"

namespace topple::solids {

// Where patches meet: the least-squares solution next to a place, along as many directions as they
// determine well. Grid frame, metres.
class MeetingPoint {
  public:
    MeetingPoint(std::span<const SurfacePatch> patches, double voxel_m)
        : patches_(patches), h_(voxel_m) {}

    // Next to `base`; `base` itself where they meet far from `corner` only.
    Vec3 operator()(std::span<const std::uint32_t> of, const Vec3& base, const Vec3& corner) const;

  private:
    // How well the patches determine each direction at a place: eigenvalues of the sum of their
    // normals' squares, ascending, and eigenvectors.
    struct Spread {
        Eigen::Vector3d values;
        Eigen::Matrix3d vectors;
    };
    Spread spread(std::span<const std::uint32_t> of, const Vec3& x) const;
    bool settle(const SurfacePatch& patch, Vec3& x) const;
    bool settle(std::span<const std::uint32_t> of, int rank, const Spread& first, bool flat,
                Vec3& x) const;
    bool near(const Vec3& x, const Vec3& corner) const;

    std::span<const SurfacePatch> patches_;
    double h_;
};

}  // namespace topple::solids
