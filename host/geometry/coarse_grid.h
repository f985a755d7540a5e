// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/scene_bounds.h"

namespace topple::geometry {

// Cubic cells over the bounds of a scene; strays far from all others lie in none, which keeps the
// cells small. The scene's frame, metres.
class CoarseGrid {
  public:
    CoarseGrid() = default;
    // Of points, one at least. Cells have edges of `cell_m`, or grow by `growth` until there are no
    // more of them than `most`.
    CoarseGrid(const std::array<std::span<const float>, 3>& points, double cell_m, double growth,
               double most)
        : cell_m_(cell_m), bounds_(scene_bounds<float>(points, static_cast<float>(cell_m))) {
        low_ = Eigen::Vector3d(bounds_.low[0], bounds_.low[1], bounds_.low[2]);
        const Eigen::Vector3d extent =
            Eigen::Vector3d(bounds_.high[0], bounds_.high[1], bounds_.high[2]) - low_;
        const auto cells = [&] {
            double all = 1;
            for (int a = 0; a < 3; ++a) all *= std::floor(extent[a] / cell_m_) + 1;
            return all;
        };
        while (cells() > most) cell_m_ *= growth;
        for (int a = 0; a < 3; ++a) size_[a] = static_cast<std::int64_t>(extent[a] / cell_m_) + 1;
    }

    double cell_m() const { return cell_m_; }
    std::size_t size() const { return static_cast<std::size_t>(size_[0] * size_[1] * size_[2]); }
    bool is_stray(float x, float y, float z) const { return !bounds_.contains(x, y, z); }
    // A place in cells from the grid's lowest corner, and the cell there; -1 outside of the grid.
    Eigen::Vector3d in_cells(const Eigen::Vector3d& p) const { return (p - low_) / cell_m_; }
    std::int64_t cell_at(const Eigen::Vector3d& in_cells) const {
        for (int a = 0; a < 3; ++a)
            if (!(in_cells[a] >= 0 && in_cells[a] < static_cast<double>(size_[a]))) return -1;
        const auto at = [&](int a) { return static_cast<std::int64_t>(in_cells[a]); };
        return (at(0) * size_[1] + at(1)) * size_[2] + at(2);
    }
    std::int64_t cell_of(const Eigen::Vector3d& p) const { return cell_at(in_cells(p)); }

  private:
    double cell_m_ = 0;
    Bounds<float> bounds_;
    Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
    std::array<std::int64_t, 3> size_{};
};

}  // namespace topple::geometry
