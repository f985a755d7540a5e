// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/place_hash.h"
#include "topple/cloud_view.h"
#include "topple/input.h"

namespace topple::solids {

// A cloud's points in the grid frame. The cloud's must stay where they are.
class GridPoints {
  public:
    // axes: of the grid frame, in the cloud's.
    GridPoints(const CloudView& cloud, const std::array<Vec3, 3>& axes)
        : x_(cloud.x), y_(cloud.y), z_(cloud.z), axes_(axes) {}

    const std::array<Vec3, 3>& axes() const { return axes_; }
    std::size_t size() const { return x_.size(); }
    Eigen::Vector3d operator[](std::size_t n) const {
        const double x = x_[n], y = y_[n], z = z_[n];
        Eigen::Vector3d out;
        for (int a = 0; a < 3; ++a) out[a] = axes_[a][0] * x + axes_[a][1] * y + axes_[a][2] * z;
        return out;
    }
    // Every so many of them, the same ones in whatever order they come.
    bool is_chosen(std::size_t n, std::size_t step) const {
        return (place_hash(x_[n], y_[n], z_[n]) >> 32) % step == 0;
    }

  private:
    FloatColumn x_, y_, z_;
    std::array<Vec3, 3> axes_;
};

// Labels of points, -1 for none.
struct PointLabels {
    std::vector<std::int32_t> primitive, patch;
    // Of each of so many patches the highest primitive that its points have.
    std::vector<std::int32_t> primitive_of_patch(std::size_t patches) const {
        std::vector<std::int32_t> out(patches, -1);
        for (std::size_t n = 0; n < patch.size(); ++n)
            if (patch[n] >= 0) out[patch[n]] = std::max(out[patch[n]], primitive[n]);
        return out;
    }
};

// Parts, in their order.
template <class T>
std::vector<T> joined(const std::vector<std::vector<T>>& parts) {
    std::vector<T> out;
    for (const std::vector<T>& part : parts) out.insert(out.end(), part.begin(), part.end());
    return out;
}

}  // namespace topple::solids
