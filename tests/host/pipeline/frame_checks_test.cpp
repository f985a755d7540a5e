// SPDX-License-Identifier: MIT
#include "points/frame_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "topple/error.h"

// What is noted about a depth camera that may mean something else than it says.
namespace topple {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> notes_of_principal_point(double cx, double cy) {
    std::vector<std::string> notes;
    note_principal_point({640, 480, 525, 525, cx, cy, 1000}, ScanOrigin::frames_folder, notes);
    return notes;
}

TEST(FrameChecks, APrincipalPointOutsideOfTheMiddleHalf) {
    for (const auto& [cx, cy] : {std::pair(319.5, 239.5), {160.0, 120.0}, {480.0, 360.0}})
        EXPECT_THAT(notes_of_principal_point(cx, cy), IsEmpty()) << cx;
    EXPECT_THAT(notes_of_principal_point(0, 0),
                ElementsAre(AllOf(HasSubstr("(0, 0)"), HasSubstr("640 x 480"),
                                  HasSubstr("intrinsics.json, mostly near (319.5, 239.5)"))));
    EXPECT_THAT(notes_of_principal_point(319.5, 479), testing::SizeIs(1));
    EXPECT_THAT(notes_of_principal_point(159, 239.5), testing::SizeIs(1));
}

TEST(FrameChecks, PosesOfAnotherConvention) {
    scenes::CameraOptions camera;
    camera.intrinsics = {96, 72, 83, 83, 47.5, 35.5, 1000};
    camera.frames = 30;
    const scenes::Sequence walk = scenes::walk(scenes::furnished_room({}), camera);
    const auto note = [&](bool flipped, ScanOrigin origin, bool backwards = false) {
        std::vector<Mat4> poses;
        for (const DepthFrame& frame : walk.frames) {
            poses.push_back(frame.camera_to_world);
            for (const std::size_t n : {1U, 5U, 9U, 2U, 6U, 10U})
                if (flipped) poses.back()[n] *= -1;
        }
        if (backwards) std::ranges::reverse(poses);
        geometry::PoseComparison frames(walk.intrinsics, poses, 2);
        for (std::size_t n = 0; n < poses.size(); ++n) frames.add(walk.frames[n], n);
        return pose_note(frames, poses.size(), origin);
    };
    const auto note_of = [&](const std::vector<Mat4>& poses) {
        geometry::PoseComparison frames(walk.intrinsics, poses, 2);
        for (std::size_t n = 0; n < poses.size(); ++n) frames.add(walk.frames[n], n);
        return pose_note(frames, poses.size(), ScanOrigin::frames_in_memory);
    };
    EXPECT_EQ(note(false, ScanOrigin::frames_folder), "");
    EXPECT_THAT(note(true, ScanOrigin::frames_folder),
                AllOf(HasSubstr("OpenGL"), HasSubstr("write into the file of poses"),
                      HasSubstr("each pose with its second and third columns negated.")));
    EXPECT_THAT(note(true, ScanOrigin::frames_in_memory), HasSubstr("give as camera_to_world"));
    EXPECT_THAT(note(false, ScanOrigin::frames_folder, true),
                AllOf(HasSubstr("The frames contradict each other"), HasSubstr("in their order"),
                      HasSubstr("of intrinsics.json are")));
    std::vector<Mat4> poses;
    for (const DepthFrame& frame : walk.frames) {
        poses.push_back(frame.camera_to_world);
        std::swap(poses.back()[1], poses.back()[4]);
        std::swap(poses.back()[2], poses.back()[8]);
        std::swap(poses.back()[6], poses.back()[9]);
    }
    EXPECT_THAT(note_of(poses), AllOf(HasSubstr("transposed rotations (column-major, or "
                                                "quaternions with x, y, z negated)"),
                                      HasSubstr("matrices are row-major")));
    poses.assign(30, walk.frames[0].camera_to_world);
    EXPECT_THAT(note_of(poses), testing::EndsWith("were the poses filled in?"));
    for (std::size_t n = 0; n < 30; ++n) {
        poses[n] = walk.frames[n].camera_to_world;
        if (n >= 12 && n < 20) poses[n][3] += 0.3;
    }
    EXPECT_THAT(note_of(poses),
                AllOf(testing::StartsWith("Frames contradict the others from frame 1"),
                      HasSubstr("off by about 0."), HasSubstr("doubled, about 0.3"),
                      HasSubstr("mended poses")));
}

TEST(FrameChecks, StepsOfACameraInAnotherUnit) {
    const auto message = [](double step) {
        const std::vector<Vec3> places{{0, 0, 0}, {step, 0, 0}, {2 * step, 0, 0}};
        try {
            check_camera_steps(places, "frames");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(message(9), "");
    EXPECT_THAT(message(30),
                testing::EndsWith("if these are mm, multiply them by 0.001, by 0.01 if "
                                  "cm"));
    EXPECT_THAT(message(3000), testing::EndsWith("if these are mm, multiply them by 0.001"));
}

}  // namespace
}  // namespace topple
