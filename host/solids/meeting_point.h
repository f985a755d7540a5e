// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/boundary_cells.h"

namespace topple::solids {

// Where patches meet: the least-squares solution next to a place, along as many directions as they
// determine well. Grid frame, metres. Keeps what it finds of flat patches, which vertices beside
// each other ask for again and again: each thread takes one of its own.
class MeetingPoint {
  public:
    MeetingPoint(std::span<const SurfacePatch> patches, double voxel_m)
        : patches_(patches), h_(voxel_m), known_(known) {}

    // Next to `base`; `base` itself where they meet far from `corner` only.
    Vec3 operator()(std::span<const std::uint32_t> of, const Vec3& base, const Vec3& corner);

  private:
    // How well the patches determine each direction at a place: eigenvalues of the sum of their
    // normals' squares, ascending, and eigenvectors.
    struct Spread {
        Eigen::Vector3d values;
        Eigen::Matrix3d vectors;
    };
    // That of a few flat patches, which is the same everywhere.
    struct Known {
        std::array<std::uint32_t, 3> of{};
        std::size_t count = 0;
        Spread spread;
    };
    static constexpr std::size_t known = 256;

    Spread spread(std::span<const std::uint32_t> of, const Vec3& x) const;
    Known& place_of(std::span<const std::uint32_t> of);
    bool settle(const SurfacePatch& patch, Vec3& x) const;
    bool settle(std::span<const std::uint32_t> of, int rank, const Spread& first, bool flat,
                Vec3& x) const;
    bool near(const Vec3& x, const Vec3& corner) const;

    std::span<const SurfacePatch> patches_;
    double h_;
    std::vector<Known>
        known_;  // by the patches' numbers, the last ones of those that share a place
};

}  // namespace topple::solids
