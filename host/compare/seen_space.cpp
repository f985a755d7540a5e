// SPDX-License-Identifier: MIT
#include "compare/seen_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "core/rotation.h"
#include "topple/error.h"

namespace topple::comparing {
namespace {

// Two scans lie on each other to about this.
constexpr double least_reach_m = 0.025;
constexpr std::int64_t most_cells = std::int64_t{1} << 28;

std::int64_t cell_of(double at_m, double voxel_m) {
    return static_cast<std::int64_t>(std::floor(at_m / voxel_m));
}

}  // namespace

SeenSpace::SeenSpace(const Scene& scene, const SpaceMap& space)
    : voxel_m_(scene.voxel_size_m), reach_m_(std::max(least_reach_m, 1.01 * voxel_m_)) {
    const SolidVoxels& solid = scene.solid;
    std::vector<Cell> solids(solid.x.size());
    Cell high{};
    low_.fill(std::numeric_limits<std::int64_t>::max());
    high.fill(std::numeric_limits<std::int64_t>::min());
    const auto include = [&](const Cell& at) {
        for (std::size_t a = 0; a < 3; ++a) {
            low_[a] = std::min(low_[a], at[a]);
            high[a] = std::max(high[a], at[a]);
        }
    };
    for (std::size_t n = 0; n < solids.size(); ++n) {
        const Vec3 at =
            transformed(scene.manhattan_from_input, {solid.x[n], solid.y[n], solid.z[n]});
        for (std::size_t a = 0; a < 3; ++a) solids[n][a] = cell_of(at[a], voxel_m_);
        include(solids[n]);
    }
    for (const SpaceMap::Box& box : space.free) {
        include({box.low[0], box.low[1], box.low[2]});
        include({box.high[0], box.high[1], box.high[2]});
    }
    if (low_[0] > high[0]) return;
    std::int64_t all = 1;
    for (std::size_t a = 0; a < 3; ++a) {
        size_[a] = high[a] - low_[a] + 1;
        if (size_[a] > most_cells / all)
            throw Error(ErrorKind::input, scene.source +
                                              ": is too large to be compared: it spans more than " +
                                              std::to_string(most_cells) +
                                              " voxels; parse it with a larger voxel_m (--voxel)");
        all *= size_[a];
    }
    cells_.assign(static_cast<std::size_t>(all), unseen);
    const auto place = [&](std::int64_t i, std::int64_t j, std::int64_t k) -> std::int32_t& {
        return cells_[static_cast<std::size_t>(
            ((i - low_[0]) * size_[1] + (j - low_[1])) * size_[2] + (k - low_[2]))];
    };
    for (const SpaceMap::Box& box : space.free)
        for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i)
            for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j)
                std::fill_n(&place(i, j, box.low[2]), box.high[2] - box.low[2] + 1, free);
    for (std::size_t n = 0; n < solids.size(); ++n)
        place(solids[n][0], solids[n][1], solids[n][2]) = solid.object[n];

    const auto reach = static_cast<std::int64_t>(reach_m_ / voxel_m_);
    const auto square = [](const Cell& c) { return c[0] * c[0] + c[1] * c[1] + c[2] * c[2]; };
    const double most = reach_m_ * reach_m_ / (voxel_m_ * voxel_m_);
    for (std::int64_t i = -reach; i <= reach; ++i)
        for (std::int64_t j = -reach; j <= reach; ++j)
            for (std::int64_t k = -reach; k <= reach; ++k)
                if (static_cast<double>(square({i, j, k})) <= most) around_.push_back({i, j, k});
    std::ranges::sort(around_, [&](const Cell& a, const Cell& b) {
        return std::tuple(square(a), a) < std::tuple(square(b), b);
    });
}

std::int32_t SeenSpace::cell(const Cell& at) const {
    std::array<std::int64_t, 3> n{};
    for (std::size_t a = 0; a < 3; ++a) {
        n[a] = at[a] - low_[a];
        if (n[a] < 0 || n[a] >= size_[a]) return unseen;
    }
    return cells_[static_cast<std::size_t>((n[0] * size_[1] + n[1]) * size_[2] + n[2])];
}

SeenSpace::Cell SeenSpace::cell_at(const Vec3& place_m) const {
    Cell out{};
    for (std::size_t a = 0; a < 3; ++a) out[a] = cell_of(place_m[a], voxel_m_);
    return out;
}

std::int32_t SeenSpace::at(const Vec3& place_m) const {
    const Cell here = cell_at(place_m);
    for (const Cell& step : around_) {
        const std::int32_t there = cell({here[0] + step[0], here[1] + step[1], here[2] + step[2]});
        if (there >= of_none) return there;
    }
    return cell(here);
}

bool SeenSpace::near_others(const Vec3& place_m, std::int32_t object) const {
    const Cell here = cell_at(place_m);
    return std::ranges::any_of(around_, [&](const Cell& step) {
        const std::int32_t there = cell({here[0] + step[0], here[1] + step[1], here[2] + step[2]});
        return there >= of_none && there != object;
    });
}

}  // namespace topple::comparing
