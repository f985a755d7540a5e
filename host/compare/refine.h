// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "compare/side.h"

namespace topple::comparing {

// Moves surfaces onto others: Gauss-Newton steps on the distances to the planes of the nearest
// pieces that face the same way (Chen and Medioni 1992), of those within a reach that shrinks.
class Refinement {
  public:
    explicit Refinement(std::span<const SurfacePoint> onto);

    struct Refined {
        Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
        double error_m = 0;  // root mean square of the last distances
    };
    Refined refine(std::span<const SurfacePoint> moved, const Eigen::Isometry3d& guess) const;

  private:
    using Cell = std::array<std::int64_t, 3>;
    static Cell cell_of(const Eigen::Vector3d& place);
    const SurfacePoint* nearest(const Eigen::Vector3d& place, const Eigen::Vector3d& normal,
                                double reach_m) const;

    std::span<const SurfacePoint> onto_;
    std::map<Cell, std::vector<std::size_t>> cells_;
    Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
};

}  // namespace topple::comparing
