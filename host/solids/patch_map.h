// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <vector>

#include "core/place.h"
#include "core/thread_pool.h"
#include "solids/grid_points.h"

namespace topple::solids {

// The patches seen in each cell of a coarse grid.
class PatchMap {
  public:
    // Of the points that have a patch, and that `counts` allows; -1 is no patch.
    PatchMap(const GridPoints& points, std::span<const std::int32_t> patch_of_point,
             std::span<const std::int32_t> counts, double cell_m, ThreadPool& threads);

    Place cell_of(const Eigen::Vector3d& p) const;
    // In the cell of a point, and those beside it: ascending, each once. Kept in `room` where
    // nothing was seen in the cell itself.
    std::span<const std::int32_t> around(const Eigen::Vector3d& p,
                                         std::vector<std::int32_t>& room) const;

  private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    std::uint32_t find(std::uint64_t key) const;
    std::span<const std::int32_t> seen_in(std::uint32_t cell) const {
        return std::span(patch_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
    }
    void gather(const Place& at, std::vector<std::int32_t>& out) const;
    void hash_cells();
    void gather_all(ThreadPool& threads);

    double cell_m_;
    std::vector<std::uint64_t> key_;    // of the cells, ascending
    std::vector<std::uint32_t> first_;  // CSR over the cells: their parts of `patch_`
    std::vector<std::int32_t> patch_;
    std::vector<std::uint32_t> slots_;       // open addressing by key: cells, or none
    std::vector<std::uint32_t> near_first_;  // CSR over the cells: their parts of `near_`
    std::vector<std::int32_t> near_;         // around each
};

}  // namespace topple::solids
