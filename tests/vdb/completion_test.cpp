// SPDX-License-Identifier: MIT
#include "vdb/completion.h"

#include "boxes.h"
#include "core/scan_gaps.h"
#include "device/devices.h"
#include "errors.h"
#include "host/solids/cell_column.h"
#include "topple/kernels/device.h"
#include "vdb/boxes.h"
#include "vdb/fill_leaves.h"
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

const std::vector<Role> walls{Role::wall};

// What filling makes of the boxes.
VoxelScene filled(const Boxes& boxes, std::vector<Role> roles = walls) {
    const auto device = device::open_native();
    VoxelScene scene({.voxel_m = h}, boxes.cloud, boxes.label);
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    fill(*device, scene, {.columns = true, .lowest = 0, .roles = std::move(roles)});
    return scene;
}

// Commits what a rule proposes; voxels that change.
template <class Rule>
std::size_t apply(VoxelScene& scene, const std::vector<Role>& roles, const Rule& rule) {
    SolidCells cells = scene.solid_cells();
    const std::vector<Claim> claims = rule(VolumeView(scene, cells, roles));
    commit(claims, scene, cells);
    EXPECT_EQ(cells.primitive, scene.solid_cells().primitive);
    EXPECT_EQ(cells.k, scene.solid_cells().k);
    return claims.size();
}

// Voxels of a primitive.
std::vector<Voxel> voxels_of(const VoxelScene& scene, std::int32_t primitive) {
    const SolidCells cells = scene.solid_cells();
    std::vector<Voxel> out;
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (cells.primitive[n] == primitive) out.push_back(place_of(cells, n));
    return out;
}

// Completed voxels of a primitive below a height.
std::size_t completed_below(const VoxelScene& scene, std::int32_t primitive, double height) {
    const SolidCells cells = scene.solid_cells();
    std::size_t count = 0;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        count += cells.primitive[n] == primitive && cells.basis[n] != Basis::surface &&
                 (cells.k[n] + 1) * h < height;
    }
    return count;
}

// Readings at the foot of two of the box's sides, off by the noise of the sensor: rays through the
// table top that the box hides end at them, and at the box's top.
void add_noisy_foot(Boxes& scene, std::int32_t label, double half, double z) {
    for (double along = -half; along < half; along += 0.5 * h) {
        for (const auto& [x, y] : {std::pair(half, along), std::pair(along, half)}) {
            test::add(scene.cloud, x, y, z);
            scene.label.push_back(label);
        }
    }
}

TEST(Completion, ABoxDoesNotSinkIntoTheTableThatItHides) {
    Boxes boxes = seen_from_around({{{-2, -2, -0.2}, {2, 2, 0}},
                                    {{-0.6, -0.5, 0.5}, {0.6, 0.5, 0.6}},
                                    {{-0.15, -0.15, 0.6}, {0.15, 0.15, 0.8}}});
    add_noisy_foot(boxes, 2, 0.15, 0.59);
    VoxelScene scene = filled(boxes, {});
    ASSERT_GT(completed_below(scene, 2, 0.61), 100u);
    EXPECT_GT(apply(scene, {}, [](const VolumeView& v) { return support_claims(v); }), 100u);
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
    VoxelScene scene = filled(boxes);
    const std::size_t before = completed_below(scene, 1, 0.11);
    ASSERT_GT(completed_below(scene, 2, 0.11), 100u);
    const Ledge on{.above = 2, .below = 1, .height_m = 0.1};
    EXPECT_GT(apply(scene, walls,
                    [&](const VolumeView& v) {
                        return support_claims(v, {&on, 1});
                    }),
              100u);
    EXPECT_EQ(completed_below(scene, 2, 0.11), 0u);
    EXPECT_GT(completed_below(scene, 1, 0.11), before + 100);
}

TEST(Completion, ASofasArmIsNoThingOnItsSeat) {
    const Boxes boxes = seen_from_around({{{-2, -2, -0.2}, {2, 2, 0}},
                                          {{-0.4, -0.4, 0}, {0.4, 0.4, 0.4}},
                                          {{0.4, -0.4, 0}, {0.6, 0.4, 0.6}}});
    VoxelScene scene = filled(boxes);
    const std::size_t before = completed_below(scene, 2, 0.4);
    ASSERT_GT(before, 100u);
    EXPECT_EQ(apply(scene, walls, [](const VolumeView& v) { return support_claims(v); }), 0u);
    EXPECT_EQ(completed_below(scene, 2, 0.4), before);
}

TEST(Completion, ALegGoesOnToTheSeatAndAPostWhoseTopWasSeenDoesNot) {
    const Boxes boxes = seen_from_around({{{-2, -2, -0.2}, {2, 2, 0}},
                                          {{-0.25, -0.25, 0.4}, {0.25, 0.25, 0.46}},
                                          {{-0.12, -0.03, 0}, {-0.06, 0.03, 0.4}},
                                          {{0.06, -0.03, 0}, {0.12, 0.03, 0.1}}});
    VoxelScene scene = filled(boxes);
    const auto highest = [&](std::int32_t primitive) {
        std::int32_t top = -1;
        for (const Voxel& v : voxels_of(scene, primitive)) top = std::max(top, v[2]);
        return top;
    };
    const std::int32_t post = highest(3);
    ASSERT_LT(highest(2), 17);
    EXPECT_GT(apply(scene, walls, [](const VolumeView& v) { return leg_claims(v); }), 0u);
    EXPECT_EQ(highest(2), 19) << "one below the seat";
    EXPECT_EQ(highest(3), post);
}

// As the rear leg of a chair does, below its seat and its back.
TEST(Completion, ALegGoesOnToAllThatItEndsBelow) {
    const Boxes boxes = seen_from_around({{{-2, -2, -0.2}, {2, 2, 0}},
                                          {{-0.25, -0.25, 0.4}, {-0.09, 0.25, 0.46}},
                                          {{-0.12, -0.03, 0}, {-0.06, 0.03, 0.4}},
                                          {{-0.09, -0.25, 0.4}, {0.25, 0.25, 0.46}}});
    VoxelScene scene = filled(boxes);
    ASSERT_GT(apply(scene, walls, [](const VolumeView& v) { return leg_claims(v); }), 0u);
    std::set<std::int32_t> columns;
    for (const Voxel& v : voxels_of(scene, 2))
        if (v[2] == 19) columns.insert(v[0]);
    EXPECT_EQ(columns.size(), 4u) << "all of them, below either";
}

// A cabinet on a wall, of which the camera sees the front alone; a panel in the middle of the room.
TEST(Completion, AFrontBeforeAWallReachesToItUnlessOneSawBehind) {
    const auto backing = [](double depth, double side) {
        Boxes boxes;
        boxes.boxes = {{{-2, 1, -0.2}, {2, 1.1, 2}}, {{-0.4, 1 - depth, 0.8}, {0.4, 1, 1.3}}};
        if (side > 0) boxes.boxes[1].high[1] = 1 - depth + 0.04;
        boxes.look({0, -1.5, 1.05}, {0, 1, 1.05});
        if (side > 0)
            for (const double x : {-side, side}) boxes.look({x, -0.3, 1.05}, {0, 1, 1.05});
        const auto device = device::open_native();
        VoxelScene scene({.voxel_m = h}, boxes.cloud, boxes.label);
        scene.carve(*device, boxes.intrinsics, boxes.frames);
        const double claims =
            static_cast<double>(apply(scene, {Role::wall, Role::wall},
                                      [](const VolumeView& v) { return built_in_claims(v); }));
        return claims / (0.8 * 0.5 * depth / (h * h * h));
    };
    EXPECT_NEAR(backing(0.32, 0), 1, 0.12);
    EXPECT_EQ(backing(0.9, 0), 0) << "no furniture is so deep";
    EXPECT_LT(backing(0.5, 1.6), 0.05) << "what lies behind was seen from the sides";
}

TEST(Completion, WhatHangsTogetherWithNothingSeenIsNotSolid) {
    constexpr std::int32_t floor = 0, bottle = 1, table = 2;
    const VoxelScene scene(VoxelFrame{.voxel_m = h});
    const std::vector<Role> roles{Role::floor};
    // A bottle above a table's edge, and what was completed of it below what was seen; rays went
    // on to below the table.
    const auto dropped = [&](std::int32_t gap) {
        SolidCells cells;
        cells.voxel_m = h;
        test::add_column(cells, 0, 0, 1, floor, Basis::surface);
        test::add_column(cells, 0, 1, 4, bottle, Basis::half_enclosed);
        test::add_column(cells, 0, 30, 33, bottle, Basis::half_enclosed);
        test::add_column(cells, 0, 33 + gap, 40, bottle, Basis::surface);
        test::add_column(cells, 5, 10, 12, bottle, Basis::half_enclosed);
        test::add_column(cells, 6, 11, 20, bottle, Basis::half_enclosed);
        test::add_column(cells, 7, 19, 21, table, Basis::surface);
        return detached_claims(VolumeView(scene, cells, roles));
    };
    const std::vector<Claim> below = dropped(noise_gap);
    ASSERT_EQ(below.size(), 3u);
    EXPECT_EQ(below[2].at, (Voxel{0, 0, 3}));
    EXPECT_FALSE(below[2].solid);
    EXPECT_EQ(dropped(noise_gap + 1).size(), 3u + 3) << "the bottle's own, too far below";
}

// A closed surface of a hundred metres, say of a mesh, has more unseen voxels within than memory
// has room for: 36 bytes for each. A point for each block of its faces is enough to tell.
TEST(Completion, WhatIsTooLargeToFillIsRefused) {
    const auto device = device::open_device("native", 2);
    const auto memory = static_cast<double>(device->info().limits.memory_bytes);
    const auto blocks = static_cast<int>(std::cbrt(1.5 * memory / 12) / 8);
    PointCloud cloud;
    for (int axis = 0; axis < 3; ++axis) {
        for (int n = 0; n < 2 * blocks * blocks; ++n) {
            std::array<int, 3> at{n / 2 % blocks, n / 2 / blocks, 0};
            if (n % 2) at[2] = blocks - 1;
            std::rotate(at.begin(), at.begin() + axis, at.end());
            test::add(cloud, 0.8 * at[0] + 0.45, 0.8 * at[1] + 0.45, 0.8 * at[2] + 0.45);
        }
    }
    VoxelScene scene({0.1, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}}, cloud,
                     std::vector<std::int32_t>(cloud.size(), 0));
    test::expect_input_error([&] { fill(*device, scene, {}); }, {"use voxel_m (--voxel) = 0."});
}

// That what is left out changes nothing is what FillEqualsTheWalkOnADenseGrid shows.

// Under the floor, down to a few points three metres below, nothing was seen and nothing fills.
TEST(FillLeaves, AreFewWhereLittleCanBeFilled) {
    test::Boxes boxes = test::Boxes::on_a_floor();
    for (int n = 0; n < 2000; ++n) {
        test::add(boxes.cloud, 0.001f * static_cast<float>(n), 0, -3);
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
    const auto leaves = leaves_to_fill(scene.grids(), fills, 2, 0);
    EXPECT_GT(leaves.size(), 20u);
    EXPECT_LT(10 * leaves.size(), unseen);
    EXPECT_TRUE(std::ranges::is_sorted(leaves));
    for (const LeafTable::Leaf& leaf : leaves) EXPECT_GE(leaf[2], -1);
}

// Nothing that fills: nothing to sweep.
TEST(FillLeaves, AreNoneOfWallsAlone) {
    const test::Boxes boxes = test::Boxes::on_a_floor();
    const VoxelScene scene({}, boxes.cloud, boxes.label);
    EXPECT_TRUE(leaves_to_fill(scene.grids(), {false, false, false}, 2, 0).empty());
}

}  // namespace
}  // namespace topple::vdb
