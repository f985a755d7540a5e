// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "topple/frame_labels.h"
#include "topple/parse.h"
#include "topple/topple.h"

namespace topple::test {
namespace {

TEST(CFrames, AreParsedAsThoseOfCpp) {
    topple_status status{};
    topple_device* device = nullptr;
    ASSERT_EQ(topple_device_open("native", 2, &device, &status), TOPPLE_OK) << status.message;
    topple_options options;
    topple_options_init(&options, sizeof(options));
    options.device = device;
    topple_result* result = nullptr;
    scenes::RoomOptions plan;
    plan.seed = 3;
    scenes::CameraOptions camera;
    camera.intrinsics = {96, 72, 83, 83, 47.5, 35.5, 1000};
    camera.frames = 4;
    const scenes::Sequence walk = scenes::walk(scenes::furnished_room(plan), camera);
    std::vector<topple_frame> images(walk.frames.size());
    std::vector<double> poses;
    FramesView expected;
    expected.intrinsics = walk.intrinsics;
    for (std::size_t n = 0; n < images.size(); ++n) {
        const DepthFrame& frame = walk.frames[n];
        topple_frame_init(&images[n], sizeof(topple_frame));
        images[n].depth = frame.depth.data();
        poses.insert(poses.end(), frame.camera_to_world.begin(), frame.camera_to_world.end());
        expected.images.emplace_back().depth = {frame.depth.data(), 96, 72};
        expected.camera_to_world.push_back(frame.camera_to_world);
    }
    topple_frames frames;
    topple_frames_init(&frames, sizeof(frames));
    frames.intrinsics = {96, 72, 83, 83, 47.5, 35.5, 1000};
    frames.count = images.size();
    frames.camera_to_world = poses.data();
    EXPECT_EQ(topple_parse_frames(&frames, &options, &result, &status), TOPPLE_ERROR_USAGE);
    frames.frames = images.data();
    options.disturbances = 0;
    ASSERT_EQ(topple_parse_frames(&frames, &options, &result, &status), TOPPLE_OK)
        << status.message;
    ParseOptions same;
    same.device = device::open_device("native", 2);
    same.disturbances = {};
    const ParseResult parsed = parse(expected, same);
    const Scene& scene = parsed.scene;
    topple_scene got{};
    got.size = sizeof(got);
    ASSERT_EQ(topple_result_scene(result, &got, &status), TOPPLE_OK);
    ASSERT_EQ(got.points, scene.points.x.size());
    EXPECT_STREQ(got.source, "frames");
    EXPECT_TRUE(std::ranges::equal(scene.points.object,
                                   std::span(topple_result_point_objects(result), got.points)));
    // The labels of pixels, too, which need the result no more.
    topple_labeller* labeller = nullptr;
    ASSERT_EQ(topple_labeller_create(result, &labeller, &status), TOPPLE_OK) << status.message;
    topple_result_release(result);
    result = nullptr;
    std::vector<std::int32_t> primitives(std::size_t{96} * 72), objects(primitives.size(), -7);
    ASSERT_EQ(
        topple_labeller_label(labeller, &frames, 2, primitives.data(), objects.data(), &status),
        TOPPLE_OK)
        << status.message;
    const FrameLabels labels = FrameLabeller(parsed).label(expected, 2);
    EXPECT_EQ(primitives, labels.primitive);
    EXPECT_EQ(objects, labels.object);
    EXPECT_EQ(topple_labeller_label(labeller, &frames, 2, nullptr, nullptr, &status), TOPPLE_OK);
    EXPECT_EQ(topple_labeller_label(labeller, &frames, 4, nullptr, objects.data(), &status),
              TOPPLE_ERROR_USAGE);
    EXPECT_STREQ(status.message, "frames: there is no frame 4: they count from 0, and there are 4");
    topple_labeller_release(labeller);
    EXPECT_EQ(topple_labeller_create(nullptr, &labeller, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(labeller, nullptr);

    // One by one, up to one that can't be had.
    frames.frames = nullptr;
    frames.user = images.data();
    frames.load = [](std::uint64_t n, topple_frame* frame, void* user) {
        *frame = static_cast<topple_frame*>(user)[n];
        return n == 3 ? 7 : 0;
    };
    EXPECT_EQ(topple_parse_frames(&frames, &options, &result, &status), TOPPLE_ERROR_INPUT);
    EXPECT_STREQ(status.message, "frames: load() returned 7 for frame 3");
    frames.camera_to_world = nullptr;
    EXPECT_EQ(topple_parse_frames(&frames, &options, &result, &status), TOPPLE_ERROR_USAGE);
    frames.count = 1;
    EXPECT_EQ(topple_parse_frames(&frames, &options, &result, &status), TOPPLE_OK)
        << status.message;
    topple_result_release(result);
    topple_device_release(device);
}

}  // namespace
}  // namespace topple::test
