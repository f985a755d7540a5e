// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "topple/input.h"

namespace topple {

// What a map says of space, in its own voxels: voxel (i, j, k) spans corner_m + [(i, j, k), (i, j,
// k) + 1] * voxel_m of the input's frame. What is neither free nor solid, and shows no surface,
// nobody has seen.
struct SpaceMap {
    struct Box {
        std::array<std::int32_t, 3> low{}, high{};  // both inclusive
    };
    double voxel_m = 0;
    Vec3 corner_m{0, 0, 0};
    std::vector<Box> free;
    std::vector<Box> solid;  // known to be occupied, but within what is: no surface
};

// A map as a scan: points of its surfaces, and its free space.
struct ScannedMap {
    PointCloud cloud;
    SpaceMap space;
};

}  // namespace topple
