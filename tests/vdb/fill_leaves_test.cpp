// SPDX-License-Identifier: MIT
#include "vdb/fill_leaves.h"

#include <gtest/gtest.h>

#include "device/devices.h"
#include "vdb/boxes.h"

// That what is left out changes nothing is what FillEqualsTheWalkOnADenseGrid shows.
namespace topple::vdb {
namespace {

// Under the floor, down to a few points three metres below, nothing was seen and nothing fills.
TEST(FillLeaves, AreFewWhereLittleCanBeFilled) {
    test::Boxes boxes = test::Boxes::on_a_floor();
    for (int n = 0; n < 2000; ++n) {
        boxes.cloud.x.push_back(0.001f * static_cast<float>(n));
        boxes.cloud.y.push_back(0);
        boxes.cloud.z.push_back(-3);
        boxes.label.push_back(-1);
    }
    VoxelScene scene({}, boxes.cloud, boxes.label);
    const auto device = device::open_native();
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    const std::vector<bool> fills{false, true, true};
    const auto state = scene.grids().state->getConstAccessor();
    std::size_t unseen = 0;
    for (std::uint64_t n = 0; n < scene.grids().leaves.size(); ++n)
        unseen += !uniformly_empty(state, scene.grids().leaves.leaf_at(n));
    const auto leaves = leaves_to_fill(scene.grids(), fills, 2, true, 0);
    EXPECT_GT(leaves.size(), 20u);
    EXPECT_LT(10 * leaves.size(), unseen);
    EXPECT_TRUE(std::ranges::is_sorted(leaves));
    for (const LeafTable::Leaf& leaf : leaves) EXPECT_GE(leaf[2], -1);
}

// Nothing that fills: nothing to sweep.
TEST(FillLeaves, AreNoneOfWallsAlone) {
    const test::Boxes boxes = test::Boxes::on_a_floor();
    const VoxelScene scene({}, boxes.cloud, boxes.label);
    EXPECT_TRUE(leaves_to_fill(scene.grids(), {false, false, false}, 2, true, 0).empty());
}

}  // namespace
}  // namespace topple::vdb
