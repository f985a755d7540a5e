// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "topple/cloud_view.h"
#include "topple/input.h"

namespace topple::solids {

// A cloud's points in the grid frame, whose axes are these in the cloud's.
inline Eigen::Vector3d rotated(const std::array<Vec3, 3>& axes, double x, double y, double z) {
    Eigen::Vector3d out;
    for (int a = 0; a < 3; ++a) {
        const Vec3& row = axes[static_cast<std::size_t>(a)];
        out[a] = row[0] * x + row[1] * y + row[2] * z;
    }
    return out;
}

// The points of each label, ascending; -1 is none.
struct PointsByLabel {
    std::vector<std::size_t> first;  // CSR over the labels, and the end
    std::vector<std::uint32_t> order;

    PointsByLabel(std::span<const std::int32_t> label, std::size_t labels) : first(labels + 1, 0) {
        for (const std::int32_t l : label)
            if (l >= 0) ++first[static_cast<std::size_t>(l) + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        order.resize(first.back());
        std::vector<std::size_t> at(first.begin(), first.end() - 1);
        for (std::size_t n = 0; n < label.size(); ++n)
            if (label[n] >= 0)
                order[at[static_cast<std::size_t>(label[n])]++] = static_cast<std::uint32_t>(n);
    }
    std::span<const std::uint32_t> of(std::size_t label) const {
        return std::span(order).subspan(first[label], first[label + 1] - first[label]);
    }
};

// Every so many of the points, the same ones in whatever order they come.
inline bool is_chosen(const CloudView& cloud, std::size_t n, std::size_t step) {
    std::uint64_t mixed = 0;
    for (const float v : {cloud.x[n], cloud.y[n], cloud.z[n]})
        mixed = (mixed ^ std::bit_cast<std::uint32_t>(v)) * 0x9e3779b97f4a7c15U;
    return (mixed >> 32) % step == 0;
}

}  // namespace topple::solids
