// SPDX-License-Identifier: MIT
#include "points/pose_comparison.h"

#include <Eigen/Geometry>

#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "testing.h"

// Depth frames tell in which convention their poses were given.
namespace topple {
namespace {

using geometry::pose_conventions;
using geometry::PoseComparison;
using geometry::PoseContradiction;
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
    camera.intrinsics = {64, 48, 55, 55, 31.5, 23.5, 1000};
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
    for (const std::uint64_t seed : {1U, 2U}) {
        scenes::RoomOptions room;
        room.seed = seed;
        room.tilt_deg = seed == 2 ? 20 : 0;
        const scenes::Sequence frames =
            scenes::walk(scenes::furnished_room(room), small_camera(30));
        for (std::size_t n = 0; n < pose_conventions; ++n) {
            const auto convention = static_cast<PoseConvention>(n);
            const PoseComparison::Verdict found = comparison(frames, convention).verdict();
            if (n == 0)
                EXPECT_THAT(found.better, IsEmpty()) << seed;
            else
                EXPECT_THAT(found.better, ElementsAre(convention)) << seed;
            EXPECT_EQ(found.contradiction.has_value(), n != 0) << seed;
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
        EXPECT_FALSE(comparison(one, convention).verdict().contradiction);
        one.frames.clear();
        EXPECT_THAT(better(one, convention), IsEmpty());
        // Without readings.
        scenes::Sequence blank = walk;
        for (DepthFrame& frame : blank.frames) frame.depth.assign(frame.depth.size(), 0);
        EXPECT_THAT(better(blank, convention), IsEmpty());
        EXPECT_FALSE(comparison(blank, convention).verdict().contradiction);
        // Of different places: each frame has the depth of another.
        scenes::Sequence shuffled = walk;
        for (std::size_t n = 0; n < walk.frames.size(); ++n)
            shuffled.frames[n].depth = walk.frames[(11 * n + 5) % walk.frames.size()].depth;
        EXPECT_THAT(better(shuffled, convention), IsEmpty());
    }
}

// Along an arc, so that all frames look at the middle, and neighbours see nearly the same.
scenes::Sequence arc(std::uint64_t seed, unsigned count) {
    scenes::RoomOptions room;
    room.seed = seed;
    std::vector<Mat4> poses;
    for (unsigned n = 0; n < count; ++n) {
        const double a = 0.3 + 0.06 * n;
        poses.push_back(scenes::look_at({0.4 + 1.2 * std::cos(a), 0.4 + 1.2 * std::sin(a), 1.4},
                                        {3 - 0.03 * n, 2 + 0.05 * n, 0.6}));
    }
    return scenes::film(scenes::furnished_room(room), small_camera(count), poses);
}

// What the frames say where those from `from` up to `until` are moved in the world, as after a loop
// was closed: by a way, and by a turn about the room's middle.
std::optional<PoseContradiction> after_jump(scenes::Sequence frames, std::size_t from,
                                            std::size_t until, const Vec3& way_m, double turn_deg,
                                            bool drifts = false) {
    const Eigen::Translation3d middle(1.8, 1.8, 0), way(way_m[0], way_m[1], way_m[2]);
    for (std::size_t n = from; n < until; ++n) {
        Mat4& m = frames.frames[n].camera_to_world;
        const double share = drifts ? static_cast<double>(n - from + 1) : 1;
        const Eigen::Isometry3d moved =
            Eigen::Translation3d(share * way.translation()) * middle *
            Eigen::AngleAxisd(share * turn_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitZ()) *
            middle.inverse() * Eigen::Isometry3d(matrix(m));
        m = pose(moved.matrix());
    }
    return comparison(frames, PoseConvention::camera_to_world).verdict().contradiction;
}

TEST(PoseComparison, TellsFromWhichFrameOnPosesAreOff) {
    constexpr std::size_t count = 20;
    struct Case {
        std::size_t from, until;
        Vec3 way_m;
        double turn_deg;
    };
    for (const std::uint64_t seed : {1U, 2U}) {
        const scenes::Sequence walk = arc(seed, count);
        EXPECT_FALSE(after_jump(walk, 0, count, {0.3, 0, 0}, 5)) << "moved as one";
        for (const Case& c : {Case{8, count, {0.15, 0, 0}, 0},
                              {8, count, {0, 1.1, 0}, 0},
                              {8, count, {0.2, 0.27, 0}, 4},
                              {13, count, {0, 0.6, 0}, 0},
                              {5, count, {0, 0, 0.3}, 0},
                              {16, count, {0, 0, 0}, 6},
                              {10, 11, {0.3, 0.2, 0}, 0},
                              {9, 14, {-0.3, 0.2, 0}, 0}}) {
            const auto found = after_jump(walk, c.from, c.until, c.way_m, c.turn_deg);
            EXPECT_TRUE(found) << seed << " from " << c.from << " by " << c.way_m[0] << ' '
                               << c.way_m[1] << ' ' << c.way_m[2];
            if (!found) continue;
            EXPECT_NEAR(double(found->from), double(c.from), 1);
            EXPECT_NEAR(double(found->until), double(c.until), 1) << c.from;
            const double way = Eigen::Vector3d(c.way_m.data()).norm();
            if (c.turn_deg == 0) {
                EXPECT_NEAR(found->way_m, way, 0.1) << c.from;
            }
            EXPECT_NEAR(found->turn_deg, c.turn_deg, 2) << c.from;
            if (c.turn_deg == 0) {
                EXPECT_NEAR(found->doubled_m, way, 0.05) << c.from;
            }
        }
        for (const double way_m : {0.015, 0.03})
            EXPECT_TRUE(after_jump(walk, 0, count, {way_m, 0, 0}, 0, true)) << way_m;
    }
}

// Someone walks along before the camera, near and far, or a thing is moved away: that is a part of
// what frames see.
TEST(PoseComparison, WhatMovesInTheRoomIsNotThePoses) {
    const scenes::Sequence still = arc(1, 20);
    for (const bool walks : {true, false}) {
        for (const unsigned depth_mm : {900U, 1500U, 2300U}) {
            scenes::Sequence frames = still;
            const unsigned wide = 14'000 / depth_mm;
            for (unsigned n = 0; n < 20; ++n)
                for (std::size_t v = walks ? 6 : 24; v < 48; ++v)
                    for (std::size_t u = 0; u < wide; ++u) {
                        const std::size_t left = walks ? 2 * n : n < 10 ? 12 : 32;
                        auto& depth = frames.frames[n].depth[v * 64 + left + u];
                        depth = static_cast<std::uint16_t>(
                            std::min<unsigned>(depth == 0 ? depth_mm : depth,
                                               walks ? depth_mm + 20 * (n % 7) : depth_mm));
                    }
            EXPECT_FALSE(
                comparison(frames, PoseConvention::camera_to_world).verdict().contradiction)
                << walks << ' ' << depth_mm;
        }
    }
}

TEST(PoseComparison, OnePoseForFramesThatDiffer) {
    const scenes::Sequence walk = arc(1, 20);
    scenes::Sequence filled = walk;
    for (std::size_t n = 9; n < 20; ++n)
        filled.frames[n].camera_to_world = walk.frames[9].camera_to_world;
    const auto found = comparison(filled, PoseConvention::camera_to_world).verdict().contradiction;
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->same_pose);
    EXPECT_NEAR(double(found->from), 11, 2);
    // A camera that stands still.
    const Mat4 stand = scenes::look_at({0.5, 0.5, 1.4}, {2, 2, 0.8});
    const scenes::Sequence still =
        scenes::film(scenes::furnished_room({}), small_camera(20), std::vector<Mat4>(20, stand));
    EXPECT_NE(still.frames[0].depth, still.frames[19].depth);
    EXPECT_FALSE(comparison(still, PoseConvention::camera_to_world).verdict().contradiction);
}

// Poses in another order or scale, or other intrinsics, contradict in any convention.
TEST(PoseComparison, PoorPosesInTheRightConventionAreNoOther) {
    const scenes::Sequence walk = scenes::walk(scenes::furnished_room({}), small_camera(30));
    scenes::Sequence scaled = walk, backwards = walk, zoomed = walk;
    for (DepthFrame& frame : scaled.frames)
        for (const std::size_t axis : {3U, 7U, 11U}) frame.camera_to_world[axis] *= 0.3;
    for (std::size_t n = 0; n < walk.frames.size(); ++n)
        backwards.frames[n].depth = walk.frames[walk.frames.size() - 1 - n].depth;
    zoomed.intrinsics.fx = zoomed.intrinsics.fy = 2 * walk.intrinsics.fx;
    for (const scenes::Sequence* poor : {&scaled, &backwards, &zoomed}) {
        const auto verdict = comparison(*poor, PoseConvention::camera_to_world).verdict();
        EXPECT_TRUE(verdict.contradiction);
        EXPECT_THAT(verdict.better, IsEmpty());
    }
}

}  // namespace
}  // namespace topple
