// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "core/scene_bounds.h"
#include "topple/cloud_view.h"

namespace topple {

// How much surface a cloud shows, by the cells of 5 cm that its points occupy; they may come in any
// order.
class SurfaceExtent {
  public:
    static constexpr double cell_m = 0.05;
    // A level or upright surface occupies about one cell for each of its area, others more: 1.1 is
    // between.
    static constexpr double cells_per_area = 1.1;

    void add(double x, double y, double z) {
        const std::array<std::int64_t, 3> at{cell(x), cell(y), cell(z)};
        if (at == last_) return;
        last_ = at;
        cells_.insert(key(at));
    }
    // Whether a point was in the same cell.
    bool has(double x, double y, double z) const {
        return cells_.contains(key({cell(x), cell(y), cell(z)}));
    }
    double area_m2() const {
        return static_cast<double>(cells_.size()) * cell_m * cell_m / cells_per_area;
    }
    // With what lies between points that are so far apart.
    double area_m2(double pitch_m) const {
        return std::max(area_m2(), static_cast<double>(cells_.size()) * pitch_m * pitch_m);
    }

  private:
    static std::int64_t cell(double v) { return static_cast<std::int64_t>(std::floor(v / cell_m)); }
    static std::uint64_t key(const std::array<std::int64_t, 3>& at) {
        std::uint64_t out = 0;
        for (const std::int64_t c : at)
            out = out << 21 | (static_cast<std::uint64_t>(c) & 0x1fffff);
        return out;
    }
    std::array<std::int64_t, 3> last_{INT64_MIN, 0, 0};
    std::unordered_set<std::uint64_t> cells_;
};

inline SurfaceExtent extent_of(const CloudView& cloud) {
    SurfaceExtent out;
    for (std::size_t n = 0; n < cloud.size(); ++n) out.add(cloud.x[n], cloud.y[n], cloud.z[n]);
    return out;
}

// Where its points lie, without a few strays, as the grid of a parse does.
inline Bounds<float> bounds_of(const CloudView& cloud) {
    if (cloud.size() == 0) return {};
    const auto values = [](const FloatColumn& column) {
        return std::vector<float>(column.begin(), column.end());
    };
    const std::array<std::vector<float>, 3> at{values(cloud.x), values(cloud.y), values(cloud.z)};
    return scene_bounds<float>({at[0], at[1], at[2]}, static_cast<float>(SurfaceExtent::cell_m));
}

}  // namespace topple
