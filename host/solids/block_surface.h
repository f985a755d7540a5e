// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solids/object_voxels.h"

namespace topple::solids {

constexpr std::uint32_t no_voxel = ~std::uint32_t{0};

// One side of a filled voxel whose neighbour there is not filled.
struct VoxelFace {
    std::uint32_t voxel = 0;          // among those given
    std::uint32_t beyond = no_voxel;  // the one behind the face, if it holds a sliver
    std::uint8_t direction = 0;       // -x +x -y +y -z +z
    std::uint8_t pinched = 0;         // bits of its edges, see below; edge n begins at vertex n
    std::array<std::uint32_t, 4> vertex{};  // counter-clockwise seen from outside

    std::size_t axis() const { return direction / 2; }
    int sign() const { return direction % 2 ? 1 : -1; }
};

// The surface of a set of voxels, closed: each edge has two faces that walk it in opposite
// directions. Where two voxels touch along an edge or in a corner only, each has vertices of its
// own. They may have both ends of such an edge in common nevertheless, by way of others: that edge
// is pinched, and takes a vertex in its middle for each of the two voxels.
struct BlockSurface {
    std::vector<VoxelFace> face;
    std::vector<std::array<std::int32_t, 3>> corner;  // of each vertex, voxel corner (i, j, k)
};

// voxels: of one object, sorted by (i, j, k).
BlockSurface block_surface(std::span<const ObjectVoxel> voxels);

}  // namespace topple::solids
