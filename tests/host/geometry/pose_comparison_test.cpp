// SPDX-License-Identifier: MIT
#include "geometry/pose_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "scenes/depth_camera.h"
#include "scenes/furnished_room.h"

// Depth frames tell in which convention their poses were given.
namespace topple {
namespace {

using geometry::pose_conventions;
using geometry::pose_meant;
using geometry::PoseComparison;
using geometry::PoseConvention;

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

Matrix matrix(const Mat4& pose) {
    return Eigen::Map<const Matrix>(pose.data());
}

Mat4 pose(const Matrix& m) {
    Mat4 out;
    Eigen::Map<Matrix>(out.data()) = m;
    return out;
}

// As others give a pose that is camera to world, x right, y down, z ahead.
Mat4 given_as(PoseConvention convention, const Mat4& truth) {
    const Matrix right = matrix(truth);
    Matrix opengl = right, body = right;
    opengl.col(1) *= -1;
    opengl.col(2) *= -1;
    body.col(0) = right.col(2);
    body.col(1) = -right.col(0);
    body.col(2) = -right.col(1);
    switch (convention) {
        case PoseConvention::camera_to_world:
            return truth;
        case PoseConvention::world_to_camera:
            return pose(right.inverse());
        case PoseConvention::opengl:
            return pose(opengl);
        case PoseConvention::world_to_camera_opengl:
            return pose(opengl.inverse());
        case PoseConvention::body:
            return pose(body);
        case PoseConvention::world_to_camera_body:
            return pose(body.inverse());
        case PoseConvention::w_first:
            break;
        case PoseConvention::transposed: {
            Matrix turned = right;
            turned.topLeftCorner<3, 3>() = right.topLeftCorner<3, 3>().transpose().eval();
            return pose(turned);
        }
    }
    const Eigen::Quaterniond q(right.topLeftCorner<3, 3>().eval());
    Matrix out = right;
    out.topLeftCorner<3, 3>() = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()).toRotationMatrix();
    return pose(out);
}

scenes::CameraOptions small_camera(unsigned frames) {
    scenes::CameraOptions camera;
    camera.intrinsics = {96, 72, 83, 83, 47.5, 35.5, 1000};
    camera.frames = frames;
    return camera;
}

PoseComparison comparison(const scenes::Sequence& frames, PoseConvention convention) {
    std::vector<Mat4> poses;
    for (const DepthFrame& frame : frames.frames)
        poses.push_back(given_as(convention, frame.camera_to_world));
    PoseComparison out(frames.intrinsics, poses, 2);
    for (std::size_t n = 0; n < frames.frames.size(); ++n) out.add(frames.frames[n], n);
    return out;
}

std::vector<PoseConvention> better(const scenes::Sequence& frames, PoseConvention convention) {
    return comparison(frames, convention).verdict().better;
}

TEST(PoseComparison, NamesTheConventionInWhichFramesAgree) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        scenes::RoomOptions room;
        room.seed = seed;
        room.tilt_deg = seed == 2 ? 20 : 0;
        const scenes::Sequence frames =
            scenes::walk(scenes::furnished_room(room), small_camera(30));
        for (std::size_t n = 0; n < pose_conventions; ++n) {
            const auto convention = static_cast<PoseConvention>(n);
            const std::vector<PoseConvention> found = better(frames, convention);
            if (n == 0)
                EXPECT_THAT(found, IsEmpty()) << seed;
            else
                EXPECT_THAT(found, ElementsAre(convention)) << seed;
            EXPECT_EQ(comparison(frames, convention).verdict().contradict, n != 0) << seed;
            const Mat4& truth = frames.frames[7].camera_to_world;
            EXPECT_LT((matrix(pose_meant(given_as(convention, truth), convention)) - matrix(truth))
                          .cwiseAbs()
                          .maxCoeff(),
                      1e-12);
        }
    }
}

// A tripod at the origin turns alike in all four.
TEST(PoseComparison, NamesAllThatTheFramesDoNotTellApart) {
    const scenes::World world = scenes::furnished_room({});
    std::vector<Mat4> poses;
    const Vec3 eye{2, 2, 1.4};
    for (int n = 0; n < 12; ++n) {
        const double a = 0.25 * n;
        poses.push_back(scenes::look_at(eye, {eye[0] + std::cos(a), eye[1] + std::sin(a), eye[2]}));
    }
    scenes::Sequence frames = scenes::film(world, small_camera(12), poses);
    const Matrix first = matrix(frames.frames[0].camera_to_world);
    for (DepthFrame& frame : frames.frames)
        frame.camera_to_world = pose(first.inverse() * matrix(frame.camera_to_world));
    EXPECT_THAT(better(frames, PoseConvention::camera_to_world), IsEmpty());
    EXPECT_THAT(better(frames, PoseConvention::world_to_camera),
                UnorderedElementsAre(PoseConvention::world_to_camera, PoseConvention::opengl,
                                     PoseConvention::w_first, PoseConvention::transposed));
}

// A camera on a rail, which never turns.
TEST(PoseComparison, FramesThatMoveWithoutTurningAreCompared) {
    std::vector<Mat4> poses;
    for (int n = 0; n < 12; ++n) {
        const Vec3 eye{1.2 + 0.06 * n, 1.0 + 0.12 * n, 1.2};
        poses.push_back(scenes::look_at(eye, {eye[0] + 1, eye[1], eye[2] - 0.4}));
    }
    const scenes::Sequence frames =
        scenes::film(scenes::furnished_room({}), small_camera(12), poses);
    EXPECT_GT(comparison(frames, PoseConvention::camera_to_world).verdict().pairs, 3U);
    EXPECT_THAT(better(frames, PoseConvention::camera_to_world), IsEmpty());
    EXPECT_THAT(better(frames, PoseConvention::world_to_camera),
                testing::Contains(PoseConvention::world_to_camera));
}

TEST(PoseComparison, SaysNothingWhereFramesShareNothing) {
    const scenes::World world = scenes::furnished_room({});
    const scenes::CameraOptions camera = small_camera(30);
    scenes::Sequence walk = scenes::walk(world, camera);
    for (const auto convention : {PoseConvention::camera_to_world, PoseConvention::world_to_camera,
                                  PoseConvention::opengl}) {
        // One frame, the same one many times, and none.
        scenes::Sequence one{walk.intrinsics, {walk.frames[0]}, {}, {}, {}};
        EXPECT_THAT(better(one, convention), IsEmpty());
        one.frames.resize(20, walk.frames[0]);
        EXPECT_EQ(comparison(one, convention).verdict().pairs, 0U);
        EXPECT_THAT(better(one, convention), IsEmpty());
        EXPECT_FALSE(comparison(one, convention).verdict().contradict);
        EXPECT_FALSE(comparison(one, convention).verdict().moved);
        one.frames.clear();
        EXPECT_THAT(better(one, convention), IsEmpty());
        // Without readings.
        scenes::Sequence blank = walk;
        for (DepthFrame& frame : blank.frames) frame.depth.assign(frame.depth.size(), 0);
        EXPECT_THAT(better(blank, convention), IsEmpty());
        EXPECT_FALSE(comparison(blank, convention).verdict().contradict);
        // Of different places: each frame has the depth of another.
        scenes::Sequence shuffled = walk;
        for (std::size_t n = 0; n < walk.frames.size(); ++n)
            shuffled.frames[n].depth = walk.frames[(11 * n + 5) % walk.frames.size()].depth;
        EXPECT_THAT(better(shuffled, convention), IsEmpty());
    }
}

PoseComparison::Verdict verdict_of(const scenes::Sequence& frames) {
    return comparison(frames, PoseConvention::camera_to_world).verdict();
}

TEST(PoseComparison, OnePoseForFramesThatDiffer) {
    scenes::Sequence walk = scenes::walk(scenes::furnished_room({}), small_camera(30));
    EXPECT_EQ(verdict_of(walk).same_poses, 0U);
    // Filled in for the first half alone, then for none.
    for (const std::size_t first : {15U, 0U}) {
        for (std::size_t n = first; n < walk.frames.size(); ++n)
            walk.frames[n].camera_to_world = walk.frames[0].camera_to_world;
        const PoseComparison::Verdict found = verdict_of(walk);
        EXPECT_EQ(found.frames, 30U);
        EXPECT_EQ(found.same_poses, first == 0 ? 30U : 16U);
        EXPECT_TRUE(found.moved);
        EXPECT_LT(found.at_one_pose.agreeing_share(), 0.3);
    }
}

// Each frame has noise of its own, and something goes past.
TEST(PoseComparison, ACameraThatStandsStillDidNotMove) {
    const scenes::World world = scenes::furnished_room({});
    const Mat4 stand = scenes::look_at({0.5, 0.5, 1.4}, {2, 2, 0.8});
    scenes::Sequence still = scenes::film(world, small_camera(20), std::vector<Mat4>(20, stand));
    const auto agreeing = [&] { return verdict_of(still).at_one_pose.agreeing_share(); };
    EXPECT_EQ(verdict_of(still).same_poses, 20U);
    EXPECT_NE(still.frames[0].depth, still.frames[19].depth);
    EXPECT_GT(agreeing(), 0.9);
    EXPECT_FALSE(verdict_of(still).moved);
    for (std::size_t n = 0; n < 20; ++n) {
        for (std::size_t v = 0; v < 72; ++v)
            for (std::size_t u = 0; u < 30; ++u) still.frames[n].depth[v * 96 + (u + 3 * n)] = 500;
    }
    EXPECT_LT(agreeing(), 0.9);
    EXPECT_FALSE(verdict_of(still).moved);
}

// Poses that drift or are off in scale agree badly, and in no other convention better.
TEST(PoseComparison, PoorPosesInTheRightConventionAreNoOther) {
    scenes::Sequence walk = scenes::walk(scenes::furnished_room({}), small_camera(30));
    scenes::Sequence scaled = walk;
    for (DepthFrame& frame : scaled.frames)
        for (const std::size_t axis : {3U, 7U, 11U}) frame.camera_to_world[axis] *= 3;
    EXPECT_THAT(better(scaled, PoseConvention::camera_to_world), IsEmpty());
    scenes::Sequence backwards = walk;
    for (std::size_t n = 0; n < walk.frames.size(); ++n)
        backwards.frames[n].depth = walk.frames[walk.frames.size() - 1 - n].depth;
    EXPECT_THAT(better(backwards, PoseConvention::camera_to_world), IsEmpty());
    EXPECT_TRUE(comparison(backwards, PoseConvention::camera_to_world).verdict().contradict);
    scenes::Sequence zoomed = walk;
    zoomed.intrinsics.fx = zoomed.intrinsics.fy = 2 * walk.intrinsics.fx;
    EXPECT_THAT(better(zoomed, PoseConvention::camera_to_world), IsEmpty());
    EXPECT_TRUE(comparison(zoomed, PoseConvention::camera_to_world).verdict().contradict);
    scenes::Sequence few = walk;  // every sixth
    for (std::size_t n = 0; n < 5; ++n) few.frames[n] = walk.frames[6 * n];
    few.frames.resize(5);
    EXPECT_FALSE(comparison(few, PoseConvention::camera_to_world).verdict().contradict);
    for (std::size_t n = 0; n < walk.frames.size(); ++n) {
        const auto share = static_cast<double>(n) / static_cast<double>(walk.frames.size());
        walk.frames[n].camera_to_world[3] += 1.5 * share;
        walk.frames[n].camera_to_world[7] -= share;
    }
    EXPECT_THAT(better(walk, PoseConvention::camera_to_world), IsEmpty());
}

}  // namespace
}  // namespace topple
