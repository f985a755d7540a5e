// SPDX-License-Identifier: MIT
#include "objects/floor_heights.h"

#include <algorithm>
#include <limits>

namespace topple {

FloorHeights::FloorHeights(const SolidScene& solids) : voxel_m_(solids.cells().voxel_m) {
    const SolidCells& cells = solids.cells();
    for (std::size_t c = 0; c < cells.size(); ++c) {
        roof_m_ =
            c == 0 ? (cells.k[c] + 1) * voxel_m_ : std::max(roof_m_, (cells.k[c] + 1) * voxel_m_);
        if (solids.role(cells.primitive[c]) != Role::floor) continue;
        ++count_[cells.k[c]];
        ++all_;
    }
    for (const auto& [k, n] : count_)
        if (100 * n >= all_) levels_m_.push_back((k + 1) * voxel_m_);
}

double FloorHeights::below_m(double height_m) const {
    constexpr double slack_m = 0.05;
    const auto above = std::ranges::upper_bound(levels_m_, height_m + slack_m);
    return above == levels_m_.begin() ? height_m : std::min(*std::prev(above), height_m);
}

double FloorHeights::shaking(double floor_m) const {
    constexpr double least_storey_m = 2;
    if (levels_m_.empty() || !(floor_m - levels_m_.front() >= least_storey_m)) return 1;
    return 1 + 2 * (floor_m - levels_m_.front()) / (roof_m_ - levels_m_.front());
}

double FloorHeights::middle_m() const {
    std::size_t before = 0;
    for (const auto& [k, n] : count_) {
        before += n;
        if (before > all_ / 2) return (k + 1) * voxel_m_;
    }
    return -std::numeric_limits<double>::infinity();
}

}  // namespace topple
