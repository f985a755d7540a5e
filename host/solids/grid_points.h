// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "solids/rows.h"
#include "topple/cloud_view.h"
#include "topple/input.h"

namespace topple::solids {

// A cloud's points in the grid frame, whose axes are these in the cloud's.
inline Eigen::Vector3d rotated(const std::array<Vec3, 3>& axes, double x, double y, double z) {
    Eigen::Vector3d out;
    for (int a = 0; a < 3; ++a) {
        const Vec3& row = axes[a];
        out[a] = row[0] * x + row[1] * y + row[2] * z;
    }
    return out;
}

// The points of each label, ascending; -1 is none.
inline Rows<std::uint32_t> points_by_label(std::span<const std::int32_t> label,
                                           std::size_t labels) {
    return {labels, [&](const auto& add) {
                for (std::uint32_t n = 0; n < label.size(); ++n)
                    if (label[n] >= 0) add(static_cast<std::size_t>(label[n]), n);
            }};
}

// Parts, in their order.
template <class T>
std::vector<T> joined(const std::vector<std::vector<T>>& parts) {
    std::vector<T> out;
    for (const std::vector<T>& part : parts) out.insert(out.end(), part.begin(), part.end());
    return out;
}

// Every so many of the points, the same ones in whatever order they come.
inline bool is_chosen(const CloudView& cloud, std::size_t n, std::size_t step) {
    std::uint64_t mixed = 0;
    for (const float v : {cloud.x[n], cloud.y[n], cloud.z[n]})
        mixed = (mixed ^ std::bit_cast<std::uint32_t>(v)) * 0x9e3779b97f4a7c15U;
    return (mixed >> 32) % step == 0;
}

}  // namespace topple::solids
