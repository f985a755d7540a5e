// SPDX-License-Identifier: MIT
#include "lab/evaluation/room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "device/devices.h"
#include "vdb/voxel_scene.h"

namespace topple::evaluation {
namespace {

scenes::World box_in_a_room() {
    scenes::World w;
    w.room = {4, 3, 2};
    w.tilt = scenes::rotation({0.6, 0, 0.8}, 0.4);
    w.objects = {{"room", "room"}, {"box", "floor"}};
    w.parts.push_back({scenes::Shape::box, {2, 1.5, -0.05}, {4, 3, 0.1}, 0, 0, 0, "floor"});
    w.parts.push_back({scenes::Shape::box, {3, 1.5, 0.3}, {0.6, 0.6, 0.6}, 0, 0, 1, "box"});
    // Walls on three sides, so high that every pixel has a reading.
    w.parts.push_back({scenes::Shape::box, {4.05, 1.5, 2}, {0.1, 3, 4}, 0, 0, 0, "wall"});
    w.parts.push_back({scenes::Shape::box, {2, -0.05, 2}, {4, 0.1, 4}, 0, 0, 0, "wall"});
    w.parts.push_back({scenes::Shape::box, {2, 3.05, 2}, {4, 0.1, 4}, 0, 0, 0, "wall"});
    return w;
}

// One frame that looks along the room from x = 0.5 at a height of 1 m.
scenes::Sequence one_view(const scenes::World& w, const scenes::CameraOptions& camera) {
    scenes::Sequence sequence;
    sequence.intrinsics = camera.intrinsics;
    const Mat4 pose = scenes::look_at({0.5, 1.5, 1}, {3, 1.5, 1});
    sequence.frames.resize(1);
    scenes::render(w, camera, pose, 1, sequence.frames[0].depth);
    Mat4& m = sequence.frames[0].camera_to_world;
    for (std::size_t column = 0; column < 4; ++column) {
        const Vec3 v = w.to_input({pose[column], pose[4 + column], pose[8 + column]});
        for (std::size_t row = 0; row < 3; ++row) m[4 * row + column] = v[row];
    }
    return sequence;
}

// Half the image is 160 of 277 pixels across and 120 up: what is 2 m ahead is in view up to 1.155 m
// aside and 0.866 m up or down.
TEST(InView, IsTheImageWithinRangeInsideTheRoom) {
    const scenes::World w = box_in_a_room();
    scenes::CameraOptions camera;
    const scenes::Sequence sequence = one_view(w, camera);
    const auto sees = in_view(w, camera, sequence);
    EXPECT_TRUE(sees({2.5, 1.5, 1}));
    EXPECT_TRUE(sees({2.5, 1.5 + 1.15, 1}));
    EXPECT_FALSE(sees({2.5, 1.5 + 1.17, 1}));
    EXPECT_TRUE(sees({2.5, 1.5, 1 - 0.86}));
    EXPECT_FALSE(sees({2.5, 1.5, 1 - 0.88}));
    EXPECT_FALSE(sees({0.4, 1.5, 1})) << "behind the camera";
    EXPECT_TRUE(sees({3.9, 1.5, 0.2})) << "hidden by the box, but in the image";
    EXPECT_FALSE(sees({4.1, 1.5, 1})) << "outside of the room";
    camera.max_range_m = 1.9;
    EXPECT_FALSE(in_view(w, camera, sequence)({2.5, 1.5, 1}));
}

// One picture's voxels: nothing is invisible in front of the box, everything behind it is.
TEST(NeverSeenEmpty, IsWhatNoRayPassed) {
    const scenes::World w = box_in_a_room();
    scenes::CameraOptions camera;
    camera.noise = false;
    camera.single = true;
    scenes::Sequence sequence = one_view(w, camera);
    sequence.part.resize(1);
    sequence.part[0].resize(sequence.frames[0].depth.size());
    scenes::fuse(camera, sequence);
    vdb::VoxelFrame frame;
    for (std::size_t a = 0; a < 3; ++a) {
        Vec3 axis{};
        axis[a] = 1;
        frame.grid_from_input[a] = w.to_input(axis);
    }
    const std::vector<std::int32_t> label(sequence.cloud.size(), 0);
    const auto voxels = std::make_shared<vdb::VoxelScene>(frame, sequence.cloud, label);
    const auto device = device::open_device("native");
    voxels->carve(*device, sequence.intrinsics, sequence.frames);
    const auto sees = in_view(w, camera, sequence);
    Room room;
    room.world = w;
    room.parse.voxels = voxels;
    const SolidVoxels hidden = never_seen_empty(room, sees);
    std::size_t in_front = 0, inside = 0, outside = 0;
    for (std::size_t n = 0; n < hidden.x.size(); ++n) {
        const Vec3 p = w.to_room({hidden.x[n], hidden.y[n], hidden.z[n]});
        in_front += p[0] > 1 && p[0] < 2.6 && p[1] > 0.1 && p[1] < 2.9 && p[2] > 0.05;
        inside += w.parts[1].distance(p) < 0;
        outside += !sees(p);
    }
    EXPECT_EQ(in_front, 0u);
    EXPECT_EQ(outside, 0u);
    const auto volume = scenes::volume_score(w, hidden, frame.voxel_m, sees);
    EXPECT_GT(volume.recall.value, 0.99);
    // The box's shadow on the floor is about as large as the box.
    EXPECT_GT(volume.precision.value, 0.3);
    EXPECT_LT(volume.precision.value, 0.8);
    EXPECT_GT(inside, 10000u);
}

TEST(SurfaceAlone, KeepsWhatWasSeen) {
    SolidVoxels solid;
    solid.x = {1, 2, 3};
    solid.y = solid.z = solid.x;
    solid.state = {1, 0, 1};
    const SolidVoxels seen = surface_alone(solid);
    EXPECT_EQ(seen.x, std::vector<float>{2});
    EXPECT_EQ(seen.z, std::vector<float>{2});
}

// A single frame knows neither where the camera stood nor how it was turned: the result is judged
// in the room's frame all the same.
TEST(Room, OfASingleFrameIsJudgedInTheRoom) {
    RoomOptions options;
    options.room.seed = options.camera.seed = 2;
    options.room.tilt_deg = 10;
    options.camera.single = true;
    options.parse.voxel_m = 0.03;
    options.parse.disturbances = {"wind"};
    options.parse.device = device::open_device("native");
    const Room room = scan_and_parse(options);
    const auto nobodys = std::count(room.part.begin(), room.part.end(), -1);
    EXPECT_LT(nobodys, static_cast<std::ptrdiff_t>(room.part.size() / 20));
    const RoomScore score = judge(room);
    EXPECT_LT(score.gravity_deg, 5);
    EXPECT_GT(score.surface.precision.value, 0.9);
    EXPECT_GT(score.invisible.recall.value, 0.95);
    EXPECT_LT(score.invisible.precision.value, 0.9);
}

// A parse that says what is true, of a scan of few frames: judged as such.
TEST(Room, IsScannedParsedAndJudged) {
    RoomOptions options;
    options.room.seed = options.camera.seed = 3;
    options.camera.frames = 8;
    options.parse.voxel_m = 0.03;
    options.parse.disturbances = {"wind"};
    options.parse.device = device::open_device("native");
    const Room room = scan_and_parse(options);
    const ScenePoints& points = room.parse.scene.points;
    ASSERT_EQ(room.part.size(), points.x.size());
    ASSERT_EQ(points.region.size(), points.x.size());
    const RoomScore score = judge(room);
    EXPECT_EQ(score.seed, 3u);
    EXPECT_EQ(score.parts, room.world.parts.size());
    // Merging and grouping join, so the finer labelling misses more and claims less wrongly.
    EXPECT_GT(score.parts_by_region.missing, score.parts_by_primitive.missing);
    EXPECT_GT(score.objects_by_region.missing, score.objects_by_object.missing);
    EXPECT_LT(score.objects_by_region.false_alarm, score.objects_by_object.false_alarm);
    // What is seen is a part of what is solid, and that of what was not seen to be empty.
    EXPECT_LT(score.surface.recall.value, score.completed.recall.value);
    EXPECT_LE(score.completed.recall.value, score.invisible.recall.value);
    EXPECT_LT(score.invisible.precision.value, score.completed.precision.value);
    EXPECT_GT(score.parts_by_primitive.cut_discrepancy, 0);
    EXPECT_GT(score.relations.fixed_recall.of, 10u);
    EXPECT_GT(score.parse_s, 0);
}

}  // namespace
}  // namespace topple::evaluation
