// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include "core/random.h"
#include "device/devices.h"
#include "topple/kernels/primitives/openvdb.h"

namespace topple::test {
namespace {

using openvdb::Coord;
using primitives::SparseGrid;

// Cells here and there, a leaf that is full, and a tile.
openvdb::FloatTree some_tree() {
    openvdb::FloatTree tree;
    Random random(3);
    const auto at = [&] { return static_cast<std::int32_t>(random.below(200)) - 100; };
    for (int n = 0; n < 3000; ++n) {
        const std::int32_t i = at(), j = at(), k = at();
        tree.setValueOn(Coord(i, j, k), 1);
    }
    tree.addTile(1, Coord(512, -512, 1024), 2, true);
    tree.setValueOn(Coord(-(1 << 20), (1 << 20) - 1, 0), 1);
    tree.setValueOff(Coord(7, 7, 7));
    return tree;
}

TEST(SparseGridOfOpenVdb, GoesThereAndBack) {
    openvdb::initialize();
    const auto device = device::open_native(2);
    const openvdb::FloatTree tree = some_tree();
    const SparseGrid grid = primitives::grid_of_tree(*device, tree);
    EXPECT_EQ(grid.cells, tree.activeVoxelCount());
    const openvdb::MaskTree::Ptr back = primitives::tree_of_grid(grid);
    EXPECT_EQ(back->activeVoxelCount(), tree.activeVoxelCount());
    for (auto voxel = tree.cbeginValueOn(); voxel; ++voxel) {
        const Coord c = voxel.getCoord();
        ASSERT_TRUE(back->isValueOn(c)) << c;
    }
    // In the order of the grid's cells.
    std::vector<const openvdb::MaskTree::LeafNodeType*> leaves;
    back->getNodes(leaves);
    std::ranges::sort(leaves, {}, [](const auto* leaf) {
        const Coord c = leaf->origin();
        return std::array{c[0], c[1], c[2]};
    });
    std::vector<std::uint64_t> keys;
    for (const auto* leaf : leaves) {
        for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
            const Coord c = voxel.getCoord();
            keys.push_back(primitives::grid_key(c[0], c[1], c[2]));
        }
    }
    const auto low = grid.cell_low.download(), high = grid.cell_high.download();
    ASSERT_EQ(keys.size(), low.size());
    for (std::size_t n = 0; n < keys.size(); ++n)
        ASSERT_EQ(keys[n], std::uint64_t{high[n]} << 32 | low[n]) << n;
}

TEST(SparseGridOfOpenVdb, OfNothingIsNothing) {
    const auto device = device::open_native(1);
    const SparseGrid grid = primitives::grid_of_tree(*device, openvdb::FloatTree());
    EXPECT_EQ(grid.cells, 0u);
    EXPECT_TRUE(primitives::tree_of_grid(grid)->empty());
}

TEST(SparseGridOfOpenVdb, RefusesWhatIsTooFar) {
    const auto device = device::open_native(1);
    openvdb::FloatTree tree;
    tree.setValueOn(Coord(0, 1 << 20, 0), 1);
    try {
        primitives::grid_of_tree(*device, tree);
        FAIL() << "it was taken";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_THAT(error.what(), testing::HasSubstr("(0, 1048576, 0)"));
    }
}

TEST(SparseGridOfOpenVdb, GoesToNanoVdbFromThere) {
    const auto device = device::open_native(1);
    const openvdb::FloatTree tree = some_tree();
    const auto mask = openvdb::MaskGrid::create(
        primitives::tree_of_grid(primitives::grid_of_tree(*device, tree)));
    const auto handle = nanovdb::openToNanoVDB(*mask);
    const auto* nano = handle.grid<nanovdb::ValueMask>();
    ASSERT_NE(nano, nullptr);
    EXPECT_EQ(nano->activeVoxelCount(), tree.activeVoxelCount());
    const auto at = nano->getAccessor();
    for (auto voxel = tree.cbeginValueOn(); voxel; ++voxel) {
        const Coord c = voxel.getCoord();
        ASSERT_TRUE(at.isActive({c[0], c[1], c[2]})) << c;
    }
}

}  // namespace
}  // namespace topple::test
