// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace topple::solids {

// The patches seen in each cell of a coarse grid.
class PatchMap {
  public:
    explicit PatchMap(double cell_m) : cell_m_(cell_m) {}
    std::array<std::int32_t, 3> cell_of(const Eigen::Vector3d& p) const {
        std::array<std::int32_t, 3> out{};
        for (int a = 0; a < 3; ++a)
            out[static_cast<std::size_t>(a)] =
                static_cast<std::int32_t>(std::clamp(std::floor(p[a] / cell_m_), -2e9, 2e9));
        return out;
    }
    void add(const Eigen::Vector3d& p, std::int32_t patch) {
        const std::uint64_t cell = key(cell_of(p));
        if (cell == last_cell_ && patch == last_patch_) return;  // as of most points of a scan
        last_cell_ = cell;
        last_patch_ = patch;
        std::vector<std::int32_t>& here = cells_[cell];
        if (std::ranges::find(here, patch) == here.end()) here.push_back(patch);
    }
    // In the cell of a point, and those beside it.
    void around(const Eigen::Vector3d& p, std::vector<std::int32_t>& out) const {
        out.clear();
        const auto at = cell_of(p);
        for (std::int32_t n = 0; n < 27; ++n) {
            const auto found =
                cells_.find(key({at[0] + n / 9 - 1, at[1] + n / 3 % 3 - 1, at[2] + n % 3 - 1}));
            if (found == cells_.end()) continue;
            for (const std::int32_t patch : found->second)
                if (std::ranges::find(out, patch) == out.end()) out.push_back(patch);
        }
    }

  private:
    // 21 bits of each; cells that share a key are far from one another.
    static std::uint64_t key(const std::array<std::int32_t, 3>& at) {
        std::uint64_t out = 0;
        for (const std::int32_t a : at)
            out = out << 21 | (static_cast<std::uint32_t>(a) & 0x1fffff);
        return out;
    }
    double cell_m_;
    std::uint64_t last_cell_ = 0;
    std::int32_t last_patch_ = -1;
    std::unordered_map<std::uint64_t, std::vector<std::int32_t>> cells_;
};

}  // namespace topple::solids
