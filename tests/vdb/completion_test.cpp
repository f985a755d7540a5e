// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "boxes.h"
#include "device/device.h"
#include "device/devices.h"
#include "topple/error.h"
#include "vdb/voxel_scene.h"

// What filling alone gets wrong: things that sink into what they stand on, legs seen in part.
namespace topple::vdb {
namespace {

using test::Boxes;

constexpr double h = 0.02;

Boxes seen_from_around(std::vector<test::TestBox> boxes) {
    Boxes scene;
    scene.boxes = std::move(boxes);
    for (int n = 0; n < 8; ++n) {
        const double angle = 0.3 + n * 3.14159265 / 4;
        scene.look({1.5 * std::cos(angle), 1.5 * std::sin(angle), 1.2}, {0, 0, 0.3});
    }
    return scene;
}

// Completed voxels of a primitive below a height.
std::size_t completed_below(const VoxelScene& scene, std::int32_t primitive, double height) {
    const SolidCellArrays cells = scene.solid_cells();
    std::size_t count = 0;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        count += cells.primitive[n] == primitive && cells.state[n] == State::completed &&
                 (cells.k[n] + 1) * h < height;
    }
    return count;
}

// Readings at the foot of two of the box's sides, off by the noise of the sensor: rays through the
// table top that the box hides end at them, and at the box's top.
void add_noisy_foot(Boxes& scene, std::int32_t label, double half, double z) {
    for (double along = -half; along < half; along += 0.5 * h) {
        for (const auto& [x, y] : {std::pair(half, along), std::pair(along, half)}) {
            scene.cloud.x.push_back(static_cast<float>(x));
            scene.cloud.y.push_back(static_cast<float>(y));
            scene.cloud.z.push_back(static_cast<float>(z));
            scene.label.push_back(label);
        }
    }
}

TEST(Completion, ABoxDoesNotSinkIntoTheTableThatItHides) {
    Boxes boxes = seen_from_around({{{-2, -2, -0.2}, {2, 2, 0}},
                                    {{-0.6, -0.5, 0.5}, {0.6, 0.5, 0.6}},
                                    {{-0.15, -0.15, 0.6}, {0.15, 0.15, 0.8}}});
    add_noisy_foot(boxes, 2, 0.15, 0.59);
    const auto device = device::open_native();
    VoxelScene scene({.voxel_m = h}, boxes.cloud, boxes.label);
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    scene.fill(*device, {.columns = true, .lowest = 0, .hollow = {}});
    ASSERT_GT(completed_below(scene, 2, 0.61), 100u);
    EXPECT_GT(scene.settle({}), 100u);
    EXPECT_EQ(completed_below(scene, 2, 0.61), 0u);
    EXPECT_GT(completed_below(scene, 1, 0.61), 100u);
    EXPECT_GT(completed_below(scene, 2, 0.8), 100u) << "the box itself stays filled";
}

// Seen from above, what is under the upper book's top is taken for it down to the floor.
TEST(Completion, ABookEndsAtTheLedgeAboveTheNext) {
    Boxes boxes;
    boxes.boxes = {{{-2, -2, -0.2}, {2, 2, 0}},
                   {{-0.2, -0.16, 0}, {0.2, 0.16, 0.1}},
                   {{-0.16, -0.12, 0.1}, {0.16, 0.12, 0.2}}};
    boxes.look({0.05, 0.02, 2}, {0, 0, 0});
    const auto device = device::open_native();
    VoxelScene scene({.voxel_m = h}, boxes.cloud, boxes.label);
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    scene.fill(*device, {.columns = true, .lowest = 0, .hollow = {true}});
    const std::size_t before = completed_below(scene, 1, 0.11);
    ASSERT_GT(completed_below(scene, 2, 0.11), 100u);
    const VoxelScene::StandsOn on{.above = 2, .below = 1, .height_m = 0.1};
    EXPECT_GT(scene.settle({true}, {&on, 1}), 100u);
    EXPECT_EQ(completed_below(scene, 2, 0.11), 0u);
    EXPECT_GT(completed_below(scene, 1, 0.11), before + 100);
}

TEST(Completion, ASofasArmIsNoThingOnItsSeat) {
    const Boxes boxes = seen_from_around({{{-2, -2, -0.2}, {2, 2, 0}},
                                          {{-0.4, -0.4, 0}, {0.4, 0.4, 0.4}},
                                          {{0.4, -0.4, 0}, {0.6, 0.4, 0.6}}});
    const auto device = device::open_native();
    VoxelScene scene({.voxel_m = h}, boxes.cloud, boxes.label);
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    scene.fill(*device, {.columns = true, .lowest = 0, .hollow = {true}});
    const std::size_t before = completed_below(scene, 2, 0.4);
    ASSERT_GT(before, 100u);
    EXPECT_EQ(scene.settle({true}), 0u);
    EXPECT_EQ(completed_below(scene, 2, 0.4), before);
}

TEST(Completion, ALegGoesOnToTheSeatAndAPostWhoseTopWasSeenDoesNot) {
    const Boxes boxes = seen_from_around({{{-2, -2, -0.2}, {2, 2, 0}},
                                          {{-0.25, -0.25, 0.4}, {0.25, 0.25, 0.46}},
                                          {{-0.12, -0.03, 0}, {-0.06, 0.03, 0.4}},
                                          {{0.06, -0.03, 0}, {0.12, 0.03, 0.1}}});
    const auto device = device::open_native();
    VoxelScene scene({.voxel_m = h}, boxes.cloud, boxes.label);
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    scene.fill(*device, {.columns = true, .lowest = 0, .hollow = {true}});
    const auto highest = [&](std::int32_t primitive) {
        const SolidCellArrays cells = scene.solid_cells();
        std::int32_t top = -1;
        for (std::size_t n = 0; n < cells.size(); ++n)
            if (cells.primitive[n] == primitive) top = std::max(top, cells.k[n]);
        return top;
    };
    const std::int32_t post = highest(3);
    ASSERT_LT(highest(2), 17);
    EXPECT_GT(scene.extend({true}), 0u);
    EXPECT_EQ(highest(2), 19) << "one below the seat";
    EXPECT_EQ(highest(3), post);
}

// As the rear leg of a chair does, below its seat and its back.
TEST(Completion, ALegGoesOnToAllThatItEndsBelow) {
    const Boxes boxes = seen_from_around({{{-2, -2, -0.2}, {2, 2, 0}},
                                          {{-0.25, -0.25, 0.4}, {-0.09, 0.25, 0.46}},
                                          {{-0.12, -0.03, 0}, {-0.06, 0.03, 0.4}},
                                          {{-0.09, -0.25, 0.4}, {0.25, 0.25, 0.46}}});
    const auto device = device::open_native();
    VoxelScene scene({.voxel_m = h}, boxes.cloud, boxes.label);
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    scene.fill(*device, {.columns = true, .lowest = 0, .hollow = {true}});
    ASSERT_GT(scene.extend({true}), 0u);
    const SolidCellArrays cells = scene.solid_cells();
    std::set<std::int32_t> columns;
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (cells.primitive[n] == 2 && cells.k[n] == 19) columns.insert(cells.i[n]);
    EXPECT_EQ(columns.size(), 4u) << "all of them, below either";
}

// A closed surface of a hundred metres, say of a mesh, has more unseen voxels within than memory
// has room for: 40 bytes for each.
TEST(Completion, WhatIsTooLargeToFillIsRefused) {
    const auto device = device::open_device("native", 2);
    const auto memory = static_cast<double>(device->info().limits.memory_bytes);
    const auto edge = static_cast<float>(0.1 * std::cbrt(1.5 * memory / 40));
    PointCloud cloud;
    for (int corner = 0; corner < 8; ++corner) {
        cloud.x.push_back(corner & 1 ? edge : 0.f);
        cloud.y.push_back(corner & 2 ? edge : 0.f);
        cloud.z.push_back(corner & 4 ? edge : 0.f);
    }
    VoxelScene scene({0.1, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}}, cloud,
                     std::vector<std::int32_t>(8, 0));
    try {
        scene.fill(*device, {});
        FAIL() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_NE(std::string(error.what()).find("use --voxel 0."), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace topple::vdb
