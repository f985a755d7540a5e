// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "topple/input.h"

namespace topple::io {

// Triangles over shared vertices, counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<Vec3> vertex;
    std::vector<std::array<std::uint32_t, 3>> triangle;
};

// The boundary of a set of voxels, in units of a voxel: voxel (i, j, k) spans [i, i + 1] x [j, j +
// 1] x [k, k + 1]. Faces that lie in one plane are merged to rectangles, greedily, and these meet
// corner to corner: the surface has no gaps, and encloses exactly the voxels. Each voxel may be
// given once only.
//
// longest: rectangles end at multiples of so many voxels, for what varies along them; 0: anywhere.
TriangleMesh voxel_boundary(std::span<const std::array<std::int32_t, 3>> voxels,
                            std::int32_t longest = 0);

}  // namespace topple::io
