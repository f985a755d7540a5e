// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "topple/cloud_view.h"

// Points in the caller's memory, before anything relies on them.
namespace topple {

// Throws Error(input) where arrays differ in length or are null, or an image has another number of
// pixels.
void check_points(const CloudView& view);

// A copy without the points that are not finite.
struct FinitePoints {
    PointCloud cloud;
    std::vector<std::uint64_t> index;  // of each in the caller's arrays, ascending
};

// None where every point is finite, and so is every normal: then the caller's arrays will do. A
// normal that is not finite becomes 0, 0, 0. Throws Error(input) as check_points() does, where no
// point is finite, or for a coordinate or viewpoint beyond 1e6 m.
std::optional<FinitePoints> finite_points(const CloudView& view);

}  // namespace topple
