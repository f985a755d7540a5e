// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/coarse_grid.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// Where the sensor looked through: a coarse grid of the cells that lines of sight crossed on their
// way to the surfels. It tells merging what no surface shows: that the space under a table is no
// part of a solid. Input frame, metres.
class FreeSpace {
  public:
    // Nothing is known to be free.
    FreeSpace() = default;

    // One line of sight for each surfel, of a fixed sample where there are many. Cells with surfels
    // are not free, and a line through one of them tells nothing: viewpoints may be estimates.
    // Strays far from all others are left out, which keeps the cells small.
    // Arguments as for make_surfels; no viewpoints: nothing is known.
    FreeSpace(const Surfels& surfels, const CloudView& cloud, std::span<const Vec3> viewpoints,
              std::span<const std::uint32_t> viewpoint_of_point, ThreadPool& threads);

    bool known() const { return !cell_.empty(); }
    double cell_m() const { return grid_.cell_m(); }
    // Whether the cell around a point is free.
    bool at(const Eigen::Vector3d& p) const;
    // Whether the straight line between two points crosses free space.
    bool between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

  private:
    void cross(const Eigen::Vector3d& eye, const Eigen::Vector3d& p);

    CoarseGrid grid_;
    std::vector<std::uint8_t> cell_;  // what is known of each
};

}  // namespace topple::geometry
