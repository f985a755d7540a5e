// SPDX-License-Identifier: MIT
#include "geometry/manhattan.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "device/devices.h"
#include "geometry_random.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;

// A room with floor, four walls and a table, turned by `turn`; +-3 mm of noise.
PointCloud room(const Eigen::Matrix3d& turn, bool walls, std::uint64_t seed) {
    test::Random random(seed);
    PointCloud cloud;
    const auto add = [&](const Vector3d& p) {
        const Vector3d q =
            turn * (p + 0.003 * Vector3d(random.normal(), random.normal(), random.normal()));
        cloud.x.push_back(static_cast<float>(q[0]));
        cloud.y.push_back(static_cast<float>(q[1]));
        cloud.z.push_back(static_cast<float>(q[2]));
    };
    for (int i = 0; i < 60'000; ++i) add({4 * random.uniform(), 3 * random.uniform(), 0});
    for (int i = 0; i < 6'000; ++i)
        add({1 + 1.2 * random.uniform(), 1 + 0.7 * random.uniform(), 0.72});
    for (int i = 0; i < 60'000 && walls; ++i) {
        const double a = random.uniform(), h = 2.4 * random.uniform();
        const bool far = (random.word() & 1) != 0;
        add((random.word() & 1) != 0 ? Vector3d(far ? 4 : 0, 3 * a, h)
                                     : Vector3d(4 * a, far ? 3 : 0, h));
    }
    return cloud;
}

Eigen::Matrix3d tilt(double degrees, const Vector3d& axis) {
    return Eigen::AngleAxisd(degrees * M_PI / 180, axis.normalized()).toRotationMatrix();
}

double degrees_off(const Vec3& got, const Vector3d& want) {
    return std::acos(
               std::clamp(Vector3d(got[0], got[1], got[2]).dot(want.normalized()), -1.0, 1.0)) *
           180 / M_PI;
}

class Manhattan : public ::testing::Test {
  protected:
    Surfels surfels(const Eigen::Matrix3d& turn, bool walls) {
        const Vector3d eye = turn * Vector3d(2, 1.5, 1.3);
        const Vec3 viewpoint{eye[0], eye[1], eye[2]};
        return make_surfels(*device, room(turn, walls, 7), 0.03, {&viewpoint, 1}, {});
    }
    std::unique_ptr<device::Device> device = device::open_native();
};

TEST_F(Manhattan, FindsUpOfTiltedRooms) {
    for (const double angle : {0.0, 5.0, 15.0}) {
        const Eigen::Matrix3d turn = tilt(angle, {0.3, -0.8, 0.4});
        const Surfels s = surfels(turn, true);
        for (const bool camera : {true, false}) {
            FrameHints hints;
            // A camera that looks 25 degrees down.
            const Vector3d hint = turn * tilt(25, {1, 1, 0}) * Vector3d(0, 0, 1);
            if (camera) hints.camera_up = Vec3{hint[0], hint[1], hint[2]};
            const SceneFrame frame = find_scene_frame(*device, s, hints);
            EXPECT_TRUE(frame.found);
            EXPECT_EQ(frame.up_method, "manhattan");
            EXPECT_LT(degrees_off(frame.axes[2], turn * Vector3d(0, 0, 1)), 0.2);
            EXPECT_LT(degrees_off(frame.axes[0], turn * Vector3d(1, 0, 0)), 0.3);
            Eigen::Matrix3d axes;
            for (int i = 0; i < 3; ++i) {
                const Vec3& a = frame.axes[static_cast<std::size_t>(i)];
                axes.row(i) << a[0], a[1], a[2];
            }
            EXPECT_NEAR(axes.determinant(), 1, 1e-9);
            EXPECT_LT((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
            EXPECT_GT(frame.up_share, 0.3);
        }
    }
}

TEST_F(Manhattan, TheUsersUpWins) {
    const Surfels s = surfels(Eigen::Matrix3d::Identity(), true);
    const SceneFrame frame =
        find_scene_frame(*device, s, {.up = Vec3{0, 2, 0.1}, .camera_up = Vec3{0, 0, 1}});
    EXPECT_EQ(frame.up_method, "given");
    EXPECT_LT(degrees_off(frame.axes[2], {0, 2, 0.1}), 1e-6);
}

TEST_F(Manhattan, ATablePlaneAloneGivesUp) {
    // The camera's frame: y down, pitched down by 50 degrees.
    const Eigen::Matrix3d turn = tilt(50, {1, 0, 0}) * tilt(90, {1, 0, 0});
    const Surfels s = surfels(turn, false);
    const Vector3d up = turn * Vector3d(0, 0, 1);
    const SceneFrame frame = find_scene_frame(*device, s, {.up = {}, .camera_up = Vec3{0, -1, 0}});
    EXPECT_FALSE(frame.found);
    EXPECT_EQ(frame.up_method, "dominant-plane");
    EXPECT_LT(degrees_off(frame.axes[2], up), 0.3);
}

TEST_F(Manhattan, NothingToGoBy) {
    const Surfels none = make_surfels(*device, {}, 0.02, {}, {});
    EXPECT_EQ(find_scene_frame(*device, none, {}).up_method, "assumed");
    const SceneFrame frame =
        find_scene_frame(*device, none, {.up = {}, .camera_up = Vec3{0, -1, 0}});
    EXPECT_EQ(frame.axes[2], (Vec3{0, -1, 0}));
    EXPECT_FALSE(frame.found);
    // A ball has no direction of its own: no axes may be claimed.
    test::Random random(9);
    PointCloud ball;
    for (int i = 0; i < 40'000; ++i) {
        const Vector3d p = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
        ball.x.push_back(static_cast<float>(p[0]));
        ball.y.push_back(static_cast<float>(p[1]));
        ball.z.push_back(static_cast<float>(p[2]));
    }
    EXPECT_FALSE(find_scene_frame(*device, make_surfels(*device, ball, 0.03, {}, {}), {}).found);
}

TEST_F(Manhattan, ClustersFoldAntipodes) {
    const Surfels s = surfels(Eigen::Matrix3d::Identity(), true);
    const NormalClusters clusters = cluster_normals(*device, s, 3);
    ASSERT_EQ(clusters.direction.size(), 3u);
    EXPECT_GT(std::abs(clusters.direction[0][2]), 0.98);
    EXPECT_GE(clusters.weight[0], clusters.weight[1]);
    EXPECT_GE(clusters.weight[1], clusters.weight[2]);
}

}  // namespace
}  // namespace topple::geometry
