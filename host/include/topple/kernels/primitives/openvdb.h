// SPDX-License-Identifier: MIT
#pragma once

#include <openvdb/openvdb.h>

#include "topple/error.h"
#include "topple/kernels/primitives/sparse_grid.h"

// Sparse grids from and to OpenVDB, for programs that have it (Debian's libopenvdb-dev). Indices
// stay as they are. NanoVDB has its own way from an OpenVDB grid, nanovdb::openToNanoVDB, and back.
namespace topple::primitives {

// Of a tree's active voxels, those of active tiles among them. Throws Error(usage) where one lies
// 2^20 voxels or more from the origin along an axis.
template <class Tree>
SparseGrid grid_of_tree(device::Device& device, const Tree& tree) {
    openvdb::MaskTree active(tree, false, true, openvdb::TopologyCopy());
    active.voxelizeActiveTiles();
    std::vector<std::uint32_t> low, high;
    for (auto leaf = active.cbeginLeaf(); leaf; ++leaf) {
        const openvdb::Coord first = leaf->origin();
        constexpr std::int32_t reach = 1 << 20;
        const auto beyond = [](std::int32_t c) { return c < -reach || c >= reach; };
        if (beyond(first[0]) || beyond(first[1]) || beyond(first[2]))
            throw Error(ErrorKind::usage, "a voxel near (" + std::to_string(first[0]) + ", " +
                                              std::to_string(first[1]) + ", " +
                                              std::to_string(first[2]) +
                                              ") is 2^20 voxels or more from the origin; move the "
                                              "tree nearer to it");
        const std::uint64_t key = grid_key(first[0], first[1], first[2]);
        for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
            low.push_back(static_cast<std::uint32_t>(key) | voxel.pos());
            high.push_back(static_cast<std::uint32_t>(key >> 32));
        }
    }
    const SparseGrid::Array lows(device, low, "low words of voxels"),
        highs(device, high, "high words of voxels");
    return SparseGrid::of_keys(device, lows, highs);
}

// The grid's cells as active voxels. The nth active voxel, leaf by leaf in ascending order of their
// origins, is the grid's nth cell.
inline openvdb::MaskTree::Ptr tree_of_grid(const SparseGrid& grid) {
    const auto tree = std::make_shared<openvdb::MaskTree>();
    const std::vector<std::uint32_t> low = grid.leaf_low.download(),
                                     high = grid.leaf_high.download(), mask = grid.mask.download();
    for (std::size_t n = 0; n < grid.leaves; ++n) {
        const std::uint64_t key = std::uint64_t{high[n]} << 32 | low[n];
        const auto axis = [&](unsigned shift) {
            return (static_cast<std::int32_t>(key >> shift & 0x3ffff) << 3) - (1 << 20);
        };
        auto* const leaf = tree->touchLeaf({axis(45), axis(27), axis(9)});
        auto voxels = leaf->getValueMask();
        for (openvdb::Index w = 0; w < 8; ++w)
            voxels.template getWord<std::uint64_t>(w) =
                std::uint64_t{mask[16 * n + 2 * w + 1]} << 32 | mask[16 * n + 2 * w];
        leaf->setValueMask(voxels);
    }
    return tree;
}

}  // namespace topple::primitives
