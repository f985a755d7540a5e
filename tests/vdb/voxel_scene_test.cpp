// SPDX-License-Identifier: MIT
#include "vdb/voxel_scene.h"

#include <map>

#include "errors.h"
#include "oracle/random_depth.h"
#include "oracle/six_fill_oracle.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernels/device.h"
#include "vdb/boxes.h"
#include "vdb/completion.h"

namespace topple::vdb {
namespace {

using test::Boxes;

class Scenes : public test::EachBackend {};

using test::cloud_of;

TEST_P(Scenes, BoxesAreFilledAndDoNotLeak) {
    const Boxes boxes = Boxes::on_a_floor();
    VoxelScene scene({}, boxes.cloud, boxes.label);
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    const auto completed = fill(*device, scene, {.votes = 2, .roles = {Role::wall}});
    EXPECT_GT(completed, 500u);
    const auto cells = scene.solid_cells();
    std::array<std::uint64_t, 3> inside{};
    std::uint64_t seen_completed = 0;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (cells.basis[n] == Basis::surface) continue;
        ++seen_completed;
        const Vec3 centre{(cells.i[n] + 0.5) * 0.02, (cells.j[n] + 0.5) * 0.02,
                          (cells.k[n] + 0.5) * 0.02};
        ASSERT_GE(cells.primitive[n], 1);
        const auto p = static_cast<std::size_t>(cells.primitive[n]);
        // Nothing outside of its own box, also where the boxes touch, beyond the voxel's own size.
        EXPECT_TRUE(boxes.boxes[p].contains(centre, 0.0201))
            << p << ": " << centre[0] << " " << centre[1] << " " << centre[2];
        ++inside[p];
    }
    EXPECT_EQ(seen_completed, completed);
    for (const std::size_t p : {std::size_t{1}, std::size_t{2}}) {
        // Of the voxels a voxel inside of the box, nearly all are found.
        double volume = 1;
        for (int a = 0; a < 3; ++a)
            volume *= (boxes.boxes[p].high[a] - boxes.boxes[p].low[a] - 0.04) / 0.02;
        EXPECT_GT(static_cast<double>(inside[p]), 0.9 * volume) << "box " << p;
    }
    EXPECT_EQ(scene.state_at(30, 0, 15), State::empty);       // beside the boxes
    EXPECT_EQ(scene.state_at(0, 0, -8), State::invisible);    // under the floor
    EXPECT_EQ(scene.state_at(-8, 0, 10), State::completed);   // in the first box
    EXPECT_EQ(scene.state_at(9999, 0, 0), State::invisible);  // outside of the bounds
}

TEST_P(Scenes, NothingFillsBelowTheFloor) {
    const Boxes boxes = Boxes::on_a_floor();
    VoxelScene scene({}, boxes.cloud, boxes.label);
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    constexpr std::int32_t lowest = 5;  // as if the floor ran through the boxes
    EXPECT_GT(fill(*device, scene, {.columns = true, .lowest = lowest, .roles = {Role::wall}}),
              500u);
    const auto cells = scene.solid_cells();
    for (std::size_t n = 0; n < cells.size(); ++n)
        EXPECT_FALSE(cells.basis[n] != Basis::surface && cells.k[n] < lowest);
}

TEST_P(Scenes, FillEqualsTheWalkOnADenseGrid) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        test::Random random(seed);
        // Shells of small random boxes: they overlap, touch and leave gaps.
        std::vector<Vec3> points;
        std::vector<std::int32_t> label;
        std::vector<std::uint8_t> sides;
        std::map<std::array<int, 3>, std::array<int, 7>> sided;  // points by side, and all
        for (std::int32_t b = 0; b < 9; ++b) {
            int low[3], high[3];
            for (int a = 0; a < 3; ++a) {
                low[a] = static_cast<int>(random.below(30)) - 15;
                high[a] = low[a] + 2 + static_cast<int>(random.below(12));
            }
            for (int x = low[0]; x <= high[0]; ++x) {
                for (int y = low[1]; y <= high[1]; ++y) {
                    for (int z = low[2]; z <= high[2]; ++z) {
                        const bool shell = x == low[0] || x == high[0] || y == low[1] ||
                                           y == high[1] || z == high[2];
                        if (!shell || random.below(4) == 0) continue;
                        points.push_back({(x + 0.5) * 0.05, (y + 0.5) * 0.05, (z + 0.5) * 0.05});
                        label.push_back(random.below(20) == 0 ? -1 : b);
                        sides.push_back(
                            static_cast<std::uint8_t>(random.below(3) ? 0 : random.below(64)));
                        auto& counts = sided[{x, y, z}];
                        for (std::size_t side = 0; side < 6; ++side)
                            counts[side] += sides.back() >> side & 1;
                        ++counts[6];
                    }
                }
            }
        }
        VoxelScene scene({.voxel_m = 0.05}, cloud_of(points), label, sides);
        const Intrinsics k{64, 48, 50, 50, 31.5, 23.5, 1000};
        std::vector<DepthFrame> frames;
        for (int n = 0; n < 5; ++n) frames.push_back(oracle::random_frame(random, k, 2));
        scene.carve(*device, k, frames);
        const std::vector<Role> roles{Role::none, Role::wall, Role::none};
        const auto tiles = scene.tiles(true);
        const auto before = scene.states(tiles);
        const auto labels = scene.primitives(tiles);
        for (const unsigned votes : {1u, 2u, 3u}) {
            const bool columns = votes > 1;
            fill(*device, scene, {.votes = votes, .columns = columns, .roles = roles});
            const auto after = scene.states(tiles);
            const auto filled = scene.primitives(tiles);
            oracle::DenseCells dense;
            std::array<int, 3> low{tiles.x[0], tiles.y[0], tiles.z[0]}, high = low;
            for (std::size_t n = 0; n < tiles.size(); ++n) {
                const std::array<int, 3> at{tiles.x[n], tiles.y[n], tiles.z[n]};
                for (int a = 0; a < 3; ++a) {
                    low[a] = std::min(low[a], at[a]);
                    high[a] = std::max(high[a], at[a] + 7);
                }
            }
            for (int a = 0; a < 3; ++a) dense.size[a] = high[a] - low[a] + 1;
            dense.cell.assign(
                static_cast<std::size_t>(dense.size[0]) * dense.size[1] * dense.size[2], 0);
            const auto place = [&](std::size_t n) -> std::array<int, 3> {
                const int v = static_cast<int>(n % 512);
                return {tiles.x[n / 512] + (v >> 6) - low[0],
                        tiles.y[n / 512] + (v >> 3 & 7) - low[1],
                        tiles.z[n / 512] + (v & 7) - low[2]};
            };
            for (std::size_t n = 0; n < before.size(); ++n) {
                const bool votes_here = before[n] == 1 && labels[n] >= 0 && labels[n] != 1;
                std::uint32_t& cell = dense.cell[dense.index(place(n))];
                cell = before[n] == 2   ? 1
                       : votes_here     ? static_cast<std::uint32_t>(labels[n]) + 4
                       : before[n] == 0 ? 0
                                        : 2;
                const auto v = static_cast<int>(n % 512);
                const auto counts =
                    sided.find({tiles.x[n / 512] + (v >> 6), tiles.y[n / 512] + (v >> 3 & 7),
                                tiles.z[n / 512] + (v & 7)});
                if (!votes_here || counts == sided.end()) continue;
                const auto seen = [&](std::size_t side) {
                    const int some = counts->second[side];
                    return some > 0 && 4 * some >= counts->second[6];
                };
                for (std::size_t side = 0; side < 6; ++side)
                    if (seen(side) && !seen(side ^ 1)) cell |= 1u << (16 + side);
            }
            std::uint64_t wrong = 0, completed = 0;
            for (std::size_t n = 0; n < before.size(); ++n) {
                const std::uint32_t word =
                    oracle::six_fill(dense, place(n), static_cast<int>(votes), columns);
                const bool is_filled = (word >> 23 & 1) != 0;
                completed += is_filled;
                wrong += is_filled ? after[n] != 3 ||
                                         filled[n] != static_cast<std::int32_t>(word & 65535) - 1
                                   : after[n] != before[n] || filled[n] != labels[n];
            }
            EXPECT_EQ(wrong, 0u) << "seed " << seed << ", votes " << votes;
            EXPECT_GT(completed, 0u) << "seed " << seed << ", votes " << votes;
        }
    }
}

TEST_P(Scenes, BatchesOfFramesAddUp) {
    const Boxes boxes = Boxes::on_a_floor();
    VoxelScene whole({}, boxes.cloud, boxes.label), parts({}, boxes.cloud, boxes.label);
    whole.carve(*device, boxes.intrinsics, boxes.frames);
    const std::span<const DepthFrame> frames = boxes.frames;
    parts.carve(*device, boxes.intrinsics, frames.first(3));
    fill(*device, parts, {.votes = 2, .roles = {}});  // undone by the next frames
    parts.carve(*device, boxes.intrinsics, frames.subspan(3));
    const auto tiles = whole.tiles(true);
    EXPECT_EQ(whole.states(tiles), parts.states(tiles));
    EXPECT_EQ(whole.primitives(tiles), parts.primitives(tiles));
}

TEST_P(Scenes, SameOnEveryBackend) {
    const Boxes boxes = Boxes::on_a_floor();
    const auto parse = [&](device::Device& on) {
        VoxelScene scene({.voxel_m = 0.03}, boxes.cloud, boxes.label);
        scene.carve(on, boxes.intrinsics, boxes.frames);
        fill(on, scene, {.votes = 2, .roles = {Role::wall}});
        const auto tiles = scene.tiles(true);
        return std::pair(scene.states(tiles), scene.primitives(tiles));
    };
    EXPECT_EQ(parse(*device), parse(*device::open_device("native", 1)));
}

TEST_P(Scenes, FlyingPointsGoWallsStay) {
    Boxes boxes = Boxes::on_a_floor();
    test::add(boxes.cloud, 0.5, 0.5, 0.5);  // in the air, seen through by all frames
    boxes.label.push_back(1);
    VoxelScene scene({}, boxes.cloud, boxes.label);
    const auto before = scene.solid_cells().size();
    EXPECT_EQ(scene.state_at(25, 25, 25), State::surface);
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    EXPECT_EQ(scene.state_at(25, 25, 25), State::empty);
    EXPECT_GT(scene.solid_cells().size(), before - before / 100);
}

TEST_P(Scenes, EmptyCloudOnePointOnePlane) {
    const Intrinsics k{8, 8, 8, 8, 3.5, 3.5, 1000};
    const DepthFrame frame{std::vector<std::uint16_t>(64, 3000),
                           {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    VoxelScene empty({}, {}, {});
    empty.carve(*device, k, {&frame, 1});
    EXPECT_EQ(fill(*device, empty, {}), 0u);
    EXPECT_EQ(empty.tiles().size(), 0u);
    EXPECT_EQ(empty.tiles(true).size(), 0u);
    EXPECT_EQ(solid_voxels(empty.frame(), empty.solid_cells(), {}).x.size(), 0u);

    VoxelScene point({}, cloud_of({{0.01, -0.01, 1.01}}), std::vector<std::int32_t>{4});
    point.carve(*device, k, {&frame, 1});
    EXPECT_EQ(fill(*device, point, {}), 0u);
    EXPECT_EQ(point.state_at(0, -1, 50), State::surface);
    const auto tiles = point.tiles();
    ASSERT_EQ(tiles.size(), 1u);
    EXPECT_EQ(std::tuple(tiles.x[0], tiles.y[0], tiles.z[0]), std::tuple(0, -8, 48));
    EXPECT_EQ(point.primitives(tiles)[7 * 8 + 2], 4);

    std::vector<Vec3> plane;
    for (int x = 0; x < 50; ++x) {
        for (int y = 0; y < 50; ++y) plane.push_back({(x + 0.5) * 0.02, (y + 0.5) * 0.02, 0.51});
    }
    VoxelScene sheet({}, cloud_of(plane), std::vector<std::int32_t>(plane.size(), 0));
    EXPECT_EQ(fill(*device, sheet, {}), 0u);  // one plane closes nothing
    EXPECT_EQ(sheet.solid_cells().size(), 2500u);
}

// Labels that come later are those that would have been there from the start.
TEST_P(Scenes, LabelsMayComeLater) {
    std::vector<Vec3> points;
    std::vector<std::int32_t> label;
    for (int n = 0; n < 3000; ++n) {
        points.push_back({0.001 * (n % 97), 0.003 * (n % 31), 0.002 * (n % 53)});
        label.push_back(n % 7 - 1);
    }
    points.push_back({900, 0, 0});  // a stray
    label.push_back(2);
    const VoxelScene known({}, cloud_of(points), label);
    VoxelScene later({}, cloud_of(points));
    const Tiles tiles = known.tiles(true);
    EXPECT_EQ(later.primitives(tiles), std::vector<std::int32_t>(tiles.size() * 512, -1));
    later.set_labels(cloud_of(points), label, std::vector<std::uint8_t>(points.size(), 5));
    EXPECT_EQ(later.tiles(true).x, tiles.x);
    EXPECT_EQ(later.states(tiles), known.states(tiles));
    EXPECT_EQ(later.primitives(tiles), known.primitives(tiles));
    EXPECT_THROW(later.set_labels(cloud_of(points), std::vector<std::int32_t>{1}), Error);
    EXPECT_THROW(later.set_labels(cloud_of(points), label, std::vector<std::uint8_t>{1}), Error);
}

// A scene ten times as long with the same views: the same leaves go to the device.
TEST_P(Scenes, LeavesThatNoRayReachesCostNothing) {
    const Intrinsics k{64, 48, 50, 50, 31.5, 23.5, 1000};
    DepthFrame frame;
    frame.depth.assign(std::size_t{64} * 48, 2000);  // a wall two metres ahead
    frame.camera_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const auto carved = [&](int end) {
        std::vector<Vec3> points;
        for (int x = -40; x < end; ++x)
            for (int y = -40; y < 40; ++y)
                for (const double z : {0.025, 2.025})
                    points.push_back({x * 0.05 + 0.025, y * 0.05 + 0.025, z});
        VoxelScene scene({.voxel_m = 0.05}, cloud_of(points),
                         std::vector<std::int32_t>(points.size(), 0));
        const device::Counters before = device->counters();
        scene.carve(*device, k, {&frame, 1});
        const device::Counters& after = device->counters();
        EXPECT_EQ(scene.state_at(0, 0, 20), State::empty);
        EXPECT_EQ(scene.state_at(38, 0, 20), State::invisible);
        return std::array{
            after.dispatches - before.dispatches, after.bytes_written - before.bytes_written,
            after.bytes_read - before.bytes_read, after.bytes_bound - before.bytes_bound};
    };
    const auto once = carved(40), tenfold = carved(760);
    EXPECT_GT(once[0], 0u);
    EXPECT_EQ(once, tenfold);
}

TEST_P(Scenes, BadFramesAreRefused) {
    VoxelScene scene({}, cloud_of({{0, 0, 1}}), std::vector<std::int32_t>{0});
    const Intrinsics k{8, 8, 8, 8, 3.5, 3.5, 1000};
    DepthFrame frame;
    EXPECT_THROW(scene.carve(*device, k, {&frame, 1}), Error);  // no pixels
    frame.depth.assign(64, 1000);
    frame.camera_to_world[3] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(scene.carve(*device, k, {&frame, 1}), Error);
    EXPECT_THROW(scene.carve(*device, {1, 1, 8, 8, 0, 0, 1000}, {}), Error);
    EXPECT_THROW(scene.carve(*device, {8, 8, 0, 8, 0, 0, 1000}, {}), Error);
    EXPECT_THROW(fill(*device, scene, {.votes = 0, .roles = {}}), Error);
    scene.carve(*device, k, {});
    EXPECT_EQ(scene.state_at(0, 0, 50), State::surface);
    VoxelScene many({}, cloud_of({{0, 0, 1}}), std::vector<std::int32_t>{65534});
    EXPECT_THROW(fill(*device, many, {}), Error);
}

TOPPLE_ON_EACH_BACKEND(Scenes);

TEST(VoxelScene, MajorityLabel) {
    const auto label_of = [](const std::vector<std::int32_t>& labels) {
        VoxelScene scene({}, cloud_of(std::vector<Vec3>(labels.size(), Vec3{0.01, 0.01, 0.01})),
                         labels);
        return scene.solid_cells().primitive.at(0);
    };
    EXPECT_EQ(label_of({3, 5, 5}), 5);
    EXPECT_EQ(label_of({5, 3, 5, 3}), 3);     // the lowest of equals
    EXPECT_EQ(label_of({-1, -1, -1, 7}), 7);  // -1 only where there is nothing else
    EXPECT_EQ(label_of({-1, -5}), -1);
}

TEST(VoxelScene, StrayPointsNeitherFillMemoryNorVanish) {
    std::vector<Vec3> points;
    test::Random random(4);
    for (int n = 0; n < 5000; ++n)
        points.push_back({random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)});
    points.push_back({5000, -3000, 200});  // within reach, far from all others
    points.push_back({1e30, 0, 0});        // beyond what an index can hold
    VoxelScene scene({}, cloud_of(points), std::vector<std::int32_t>(points.size(), 0));
    EXPECT_EQ(scene.state_at(250000, -150000, 10000), State::surface);
    EXPECT_TRUE(scene.in_bounds(25, 25, 25));
    EXPECT_FALSE(scene.in_bounds(250000, -150000, 10000));
    const auto solid = scene.solid_cells();
    ASSERT_EQ(solid.i.back(), 250000);
    EXPECT_EQ(solid.primitive.back(), -1);
    EXPECT_EQ(solid.primitive.front(), 0);
    EXPECT_LT(scene.tiles(true).size(), 2000u);
    auto device = device::open_device("native");
    fill(*device, scene, {});
    EXPECT_EQ(scene.solid_cells().i.back(), 250000);
}

TEST(VoxelScene, RefusesWhatItCannotHold) {
    std::vector<Vec3> points;
    for (int n = 0; n < 1000; ++n) points.push_back({n * 3.0, n * 2.9, n * 1.0});
    const std::vector<std::int32_t> label(points.size(), 0);
    test::expect_input_error([&] { VoxelScene scene({}, cloud_of(points), label); },
                             {"voxel_m (--voxel)"});
    EXPECT_THROW(VoxelScene({.voxel_m = 0}, {}, {}), Error);
    EXPECT_THROW(VoxelScene({.voxel_m = std::numeric_limits<double>::quiet_NaN()}, {}, {}), Error);
    EXPECT_THROW(VoxelScene({}, cloud_of({{0, 0, 0}}), {}), Error);
    VoxelFrame skew;
    skew.grid_from_input[0] = {1, 1, 0};
    EXPECT_THROW(VoxelScene(skew, {}, {}), Error);
    EXPECT_THROW(VoxelScene({}, cloud_of({{1e30, 0, 0}}), std::vector<std::int32_t>{0}), Error);
}

TEST(VoxelScene, CellsAreSortedAndCentred) {
    test::Random random(8);
    std::vector<Vec3> points;
    std::vector<std::int32_t> label;
    for (int n = 0; n < 3000; ++n) {
        points.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        label.push_back(static_cast<std::int32_t>(random.below(6)) - 1);
    }
    VoxelFrame frame{0.05, {Vec3{0.6, 0.8, 0}, Vec3{-0.8, 0.6, 0}, Vec3{0, 0, 1}}};
    VoxelScene scene(frame, cloud_of(points), label);
    const auto cells = scene.solid_cells();
    const auto solid = solid_voxels(frame, cells, std::vector<std::int32_t>{10, 11, 12});
    std::set<std::array<std::int32_t, 3>> expected;
    for (const Vec3& p : points) {
        const float x = static_cast<float>(p[0]), y = static_cast<float>(p[1]),
                    z = static_cast<float>(p[2]);
        std::array<std::int32_t, 3> v;
        for (int a = 0; a < 3; ++a) {
            const Vec3& r = frame.grid_from_input[a];
            v[a] = static_cast<std::int32_t>(std::floor((r[0] * x + r[1] * y + r[2] * z) / 0.05));
        }
        expected.insert(v);
    }
    ASSERT_EQ(cells.size(), expected.size());
    ASSERT_EQ(solid.x.size(), expected.size());
    std::size_t n = 0;
    for (const auto& v : expected) {  // ordered by (i, j, k)
        ASSERT_EQ(place_of(cells, n), v);
        const double g[3] = {(v[0] + 0.5) * 0.05, (v[1] + 0.5) * 0.05, (v[2] + 0.5) * 0.05};
        EXPECT_NEAR(solid.x[n], 0.6 * g[0] - 0.8 * g[1], 1e-5);
        EXPECT_NEAR(solid.y[n], 0.8 * g[0] + 0.6 * g[1], 1e-5);
        EXPECT_NEAR(solid.z[n], g[2], 1e-5);
        EXPECT_EQ(solid.object[n],
                  solid.primitive[n] >= 0 && solid.primitive[n] < 3 ? 10 + solid.primitive[n] : -1);
        EXPECT_EQ(solid.state[n], 0);
        ++n;
    }
}

}  // namespace
}  // namespace topple::vdb
