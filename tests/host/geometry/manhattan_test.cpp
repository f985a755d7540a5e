// SPDX-License-Identifier: MIT
#include "geometry/manhattan.h"

#include <Eigen/Geometry>

#include "clouds.h"
#include "device/devices.h"
#include "testing.h"
#include "topple/kernel_testing/random.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;

// Of radius 1 m, which has no direction of its own.
PointCloud ball() {
    test::Random random(9);
    PointCloud out;
    for (int i = 0; i < 40'000; ++i) {
        test::add(out, Vector3d(random.normal(), random.normal(), random.normal()).normalized());
    }
    return out;
}

// A room with floor, four walls and a table, turned by `turn`; +-3 mm of noise.
PointCloud room(const Eigen::Matrix3d& turn, bool walls, std::uint64_t seed) {
    test::Random random(seed);
    PointCloud cloud;
    const auto add = [&](const Vector3d& p) {
        const Vector3d noise(random.normal(), random.normal(), random.normal());
        test::add(cloud, Vector3d(turn * (p + 0.003 * noise)));
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

Vec3 vec(const Vector3d& v) {
    return {v[0], v[1], v[2]};
}

class Manhattan : public ::testing::Test {
  protected:
    Surfels surfels(const Eigen::Matrix3d& turn, bool walls) {
        const Vec3 viewpoint = vec(turn * Vector3d(2, 1.5, 1.3));
        return make_surfels(*device, room(turn, walls, 7), 0.03, {&viewpoint, 1}, {});
    }
    // Of what a camera at the origin sees, whose y points down.
    SceneFrame frame_of_view(const PointCloud& cloud) {
        const Vec3 eye{0, 0, 0};
        return find_scene_frame(*device, make_surfels(*device, cloud, 0.02, {&eye, 1}, {}),
                                {.up = {}, .camera_up = Vec3{0, -1, 0}});
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
            if (camera) hints.camera_up = vec(hint);
            const SceneFrame frame = find_scene_frame(*device, s, hints);
            EXPECT_TRUE(frame.found);
            EXPECT_EQ(frame.up_method, "manhattan");
            EXPECT_LT(degrees_off(frame.axes[2], turn * Vector3d(0, 0, 1)), 0.2);
            EXPECT_LT(degrees_off(frame.axes[0], turn * Vector3d(1, 0, 0)), 0.3);
            Eigen::Matrix3d axes;
            for (int i = 0; i < 3; ++i) {
                const Vec3& a = frame.axes[i];
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

// An accelerometer's reading with the wrong sign, and one in another frame than the cloud's.
TEST_F(Manhattan, AnUpThatTheScanContradictsIsNoted) {
    const Eigen::Matrix3d turn = tilt(40, {0.3, -0.8, 0.4});
    const Surfels s = surfels(turn, true);
    const Vector3d truth = turn * Vector3d(0, 0, 1), camera = turn * Vector3d(0, 0.4, 1);
    for (const bool filmed : {false, true}) {
        const auto note = [&](const Vector3d& given) {
            FrameHints hints{.up = vec(given), .camera_up = {}};
            if (filmed) hints.camera_up = vec(camera);
            const SceneFrame frame = find_scene_frame(*device, s, hints);
            EXPECT_EQ(frame.up_method, "given");
            EXPECT_LT(degrees_off(frame.axes[2], given), 1e-4);
            return frame.note;
        };
        EXPECT_EQ(note(9.81 * truth), "");
        EXPECT_EQ(note(tilt(25, {1, 0, 0}) * truth), "");
        EXPECT_NE(note(-9.81 * truth)
                      .find("is 180 degrees from what the surfaces " +
                            std::string(filmed ? "and cameras " : "") + "show, ("),
                  std::string::npos)
            << note(-truth);
        EXPECT_THAT(note(turn * Vector3d(1, 0, 0)), testing::HasSubstr("is 90 degrees from"));
        EXPECT_THAT(note(turn * Vector3d(0.6, 0.3, 1)), testing::HasSubstr("is 34 degrees from"));
    }
}

// Where the surfaces don't tell, nobody is told that they do.
TEST_F(Manhattan, AnUpThatNothingContradictsIsNot) {
    const Surfels s = make_surfels(*device, ball(), 0.03, {}, {});
    const Surfels none = make_surfels(*device, {}, 0.02, {}, {});
    for (const Vec3& up : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{1, 0, 0}}) {
        for (const auto& camera : {std::optional<Vec3>(), std::optional(Vec3{0, -1, 0})}) {
            EXPECT_EQ(find_scene_frame(*device, s, {up, camera}).note, "");
            EXPECT_EQ(find_scene_frame(*device, none, {up, camera}).note, "");
        }
    }
}

TEST_F(Manhattan, AFormatsUpHoldsWhereTheScanDoesNotContradictIt) {
    const Eigen::Matrix3d y_up = tilt(-90, {1, 0, 0}), tilted = tilt(5, {1, 0, 1}) * y_up;
    FrameHints hints;
    hints.format_up = Vec3{0, 1, 0};
    for (const Eigen::Matrix3d& turn : {y_up, tilted}) {
        for (const bool walls : {true, false}) {
            const SceneFrame frame = find_scene_frame(*device, surfels(turn, walls), hints);
            EXPECT_EQ(frame.up_method, "format");
            EXPECT_EQ(frame.note, "");
            EXPECT_LT(degrees_off(frame.axes[2], turn * Vector3d(0, 0, 1)), 0.5);
        }
    }
    // Written with z up all the same.
    const SceneFrame other =
        find_scene_frame(*device, surfels(Eigen::Matrix3d::Identity(), true), hints);
    EXPECT_LT(degrees_off(other.axes[2], {0, 0, 1}), 0.5);
    EXPECT_THAT(other.note, testing::HasSubstr("(0, 1, 0) up, but its surfaces show (0, 0, 1)"));
    const SceneFrame none =
        find_scene_frame(*device, make_surfels(*device, {}, 0.02, {}, {}), hints);
    EXPECT_EQ(none.axes[2], (Vec3{0, 1, 0}));
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

// A board that leans in a bin, larger than what is level there. Cameras are held along z; in an
// input whose z is another direction both are told.
TEST_F(Manhattan, ASlopedBoardIsNotLevel) {
    for (const bool z_is_up : {true, false}) {
        const Eigen::Matrix3d turn = tilt(z_is_up ? 0 : 90, {1, 0, 0});
        test::Random random(5);
        PointCloud cloud;
        for (int i = 0; i < 46'000; ++i) {
            const double x = random.uniform(), y = random.uniform();
            const Vector3d at =
                i < 32'000 ? Vector3d(x, 0.4 + 0.7 * y, 0.7 * y) : Vector3d(x, 0.4 * y, 0);
            test::add(cloud, Vector3d(turn * at));
        }
        const Vec3 eye = vec(turn * Vector3d(0.5, -1, 1.5));
        const SceneFrame frame = find_scene_frame(
            *device, make_surfels(*device, cloud, 0.02, {&eye, 1}, {}),
            {.up = {}, .camera_up = vec(turn * tilt(12, {-1, 0, 0}) * Vector3d(0, 0, 1))});
        const double off = degrees_off(frame.axes[2], turn * Vector3d(0, 0, 1));
        if (z_is_up) {
            EXPECT_LT(off, 1);
        }
        EXPECT_TRUE(off < 1 || frame.note.find("Two directions") != std::string::npos) << off;
    }
}

TEST_F(Manhattan, NothingToGoBy) {
    const Surfels none = make_surfels(*device, {}, 0.02, {}, {});
    EXPECT_EQ(find_scene_frame(*device, none, {}).up_method, "assumed");
    const SceneFrame frame =
        find_scene_frame(*device, none, {.up = {}, .camera_up = Vec3{0, -1, 0}});
    EXPECT_EQ(frame.axes[2], (Vec3{0, -1, 0}));
    EXPECT_FALSE(frame.found);
    // Of a ball no axes may be claimed.
    EXPECT_FALSE(find_scene_frame(*device, make_surfels(*device, ball(), 0.03, {}, {}), {}).found);
}

// A rectangle with corner `at` and sides `a`, `b`, sampled every centimetre, seen from the origin.
void add_rectangle(PointCloud& cloud, const Vector3d& at, const Vector3d& a, const Vector3d& b) {
    for (double u = 0; u < a.norm(); u += 0.01) {
        for (double v = 0; v < b.norm(); v += 0.01) {
            test::add(cloud, Vector3d(at + u * a.normalized() + v * b.normalized()));
        }
    }
}

// Turns a view along +y with z up into the frame of a camera that looks `pitch` degrees down.
Eigen::Matrix3d to_camera(double pitch) {
    Eigen::Matrix3d level;
    level << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    return tilt(pitch, {1, 0, 0}) * level;
}

PointCloud turned(PointCloud cloud, const Eigen::Matrix3d& turn) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vector3d p = turn * Vector3d(cloud.x[i], cloud.y[i], cloud.z[i]);
        cloud.x[i] = static_cast<float>(p[0]);
        cloud.y[i] = static_cast<float>(p[1]);
        cloud.z[i] = static_cast<float>(p[2]);
    }
    return cloud;
}

TEST_F(Manhattan, OfWhatACameraSees) {
    struct Rectangle {
        Vector3d at, a, b;
    };
    const struct {
        const char* what;
        double pitch;
        std::vector<Rectangle> seen;
        bool floor;  // is there, or else the note says that none is
    } cases[] = {
        {"a large wall ahead, and a strip of the floor before it",
         20,
         {{{-1.5, 2, -1.2}, {3, 0, 0}, {0, 0, 2.4}}, {{-1.5, 1.7, -1.2}, {3, 0, 0}, {0, 0.3, 0}}},
         true},
        {"two walls",
         20,
         {{{0, 2, -0.8}, {-1.2, -1.2, 0}, {0, 0, 1.6}},
          {{0, 2, -0.8}, {1.2, -1.2, 0}, {0, 0, 1.6}}},
         false},
        {"a table straight from above, which may be a wall",
         90,
         {{{-0.6, -0.4, -1}, {1.2, 0, 0}, {0, 0.8, 0}}},
         false},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        PointCloud view;
        for (const Rectangle& r : c.seen) add_rectangle(view, r.at, r.a, r.b);
        const Eigen::Matrix3d turn = to_camera(c.pitch);
        const SceneFrame frame = frame_of_view(turned(view, turn));
        EXPECT_LT(degrees_off(frame.axes[2], turn * Vector3d(0, 0, 1)), 1);
        EXPECT_EQ(frame.note.empty(), c.floor) << frame.note;
        EXPECT_EQ(frame.up_method == "upright-surfaces", c.seen.size() == 2 && !c.floor);
    }
}

TEST_F(Manhattan, NormalsTellACamerasAxes) {
    PointCloud view;  // a wall and a floor, with normals instead of a camera
    add_rectangle(view, {-1.5, 2, -1.2}, {3, 0, 0}, {0, 0, 2.4});
    const std::size_t wall = view.size();
    add_rectangle(view, {-1.5, 1.2, -1.2}, {3, 0, 0}, {0, 0.8, 0});
    const Eigen::Matrix3d turn = to_camera(5);
    PointCloud cloud = turned(view, turn);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vector3d n = turn * (i < wall ? Vector3d(0, -1, 0) : Vector3d(0, 0, 1));
        test::add_normal(cloud, n);
    }
    const Surfels s = make_surfels(*device, cloud, 0.02, {}, {});
    EXPECT_LT(degrees_off(find_scene_frame(*device, s, {}).axes[2], turn * Vector3d(0, 0, 1)), 0.5);
}

TEST_F(Manhattan, ANarrowRoomIsNotLaidOnItsSide) {
    // A bare cloud of a corridor, 1.2 m wide and 2.5 m high, with things that stand turned in it.
    PointCloud corridor;
    add_rectangle(corridor, {0, 0, 0}, {5, 0, 0}, {0, 1.2, 0});
    for (const double y : {0.0, 1.2}) add_rectangle(corridor, {0, y, 0}, {5, 0, 0}, {0, 0, 2.5});
    for (const double x : {1.0, 2.2, 3.9}) {
        const Eigen::Matrix3d yaw = tilt(25 * x, {0, 0, 1});
        const Vector3d at(x, 0.6, 0), a = yaw * Vector3d(0.4, 0, 0), b = yaw * Vector3d(0, 0.3, 0),
                                      h(0, 0, 0.6);
        add_rectangle(corridor, at + h, a, b);
        for (const Vector3d& from : {at, Vector3d(at + b)}) add_rectangle(corridor, from, a, h);
        for (const Vector3d& from : {at, Vector3d(at + a)}) add_rectangle(corridor, from, b, h);
    }
    for (const double angle : {0.0, 8.0, 120.0}) {
        const Eigen::Matrix3d turn = tilt(angle, {0.3, -0.8, 0.4});
        const Vec3 viewpoint = vec(turn * Vector3d(0.4, 0.5, 1.4));
        const Surfels s = make_surfels(*device, turned(corridor, turn), 0.03, {&viewpoint, 1}, {});
        const SceneFrame frame = find_scene_frame(*device, s, {});
        EXPECT_LT(degrees_off(frame.axes[2], turn * Vector3d(0, 0, 1)), 0.5) << angle;
    }
}

// A level floor, two upright walls and a roof that slopes down to a third.
PointCloud attic(double slope_degrees) {
    const double slope = std::tan(slope_degrees * M_PI / 180);
    PointCloud out, gable;
    add_rectangle(out, {0, 0, 0}, {3, 0, 0}, {0, 2.6, 0});
    add_rectangle(out, {0, 0, 0}, {3, 0, 0}, {0, 0, 0.6 + 2.6 * slope});
    add_rectangle(out, {0, 2.6, 0.6}, {3, 0, 0}, {0, -2.6, 2.6 * slope});
    add_rectangle(gable, {0, 0, 0}, {0, 2.6, 0}, {0, 0, 0.6 + 2.6 * slope});
    for (std::size_t n = 0; n < gable.size(); ++n) {
        if (double{gable.z[n]} > 0.6 + (2.6 - double{gable.y[n]}) * slope) continue;
        test::add(out, gable.x[n], gable.y[n], gable.z[n]);
    }
    return out;
}

TEST_F(Manhattan, ARoofMakesNoFloorOfAWall) {
    const Vec3 eye{1.2, 0.8, 1.1};
    for (const double degrees : {15.0, 30.0, 35.0, 45.0, 60.0}) {
        const Surfels s = make_surfels(*device, attic(degrees), 0.04, {&eye, 1}, {});
        for (const bool guessed : {false, true}) {
            const SceneFrame frame =
                find_scene_frame(*device, s, {.up = {}, .camera_up = {}, .sides_guessed = guessed});
            EXPECT_LT(degrees_off(frame.axes[2], {0, 0, 1}), 0.5) << degrees;
            // A steeper one may be a wall of a room that lies on its side.
            if (degrees < 50) {
                EXPECT_EQ(frame.note, "") << degrees;
            }
        }
        EXPECT_EQ(find_scene_frame(*device, s, {.up = Vec3{0, 0, 1}, .camera_up = {}}).note, "");
    }
}

// Seen from the wrong side, as a guess may be: z is up, and the note says that it was not seen.
TEST_F(Manhattan, WhatLooksTheSameFromBelowHasZUp) {
    PointCloud floor, stairs;
    add_rectangle(floor, {0, 0, 0}, {3, 0, 0}, {0, 2.5, 0});
    for (int n = 0; n < 8; ++n) {
        add_rectangle(stairs, {0, 0.26 * n, 0.18 * n}, {1, 0, 0}, {0, 0, 0.18});
        add_rectangle(stairs, {0, 0.26 * n, 0.18 * (n + 1)}, {1, 0, 0}, {0, 0.26, 0});
    }
    const Vec3 below{0.5, 1.5, -3};
    for (const PointCloud* cloud : {&floor, &stairs}) {
        const Surfels s = make_surfels(*device, *cloud, 0.03, {&below, 1}, {});
        const SceneFrame frame =
            find_scene_frame(*device, s, {.up = {}, .camera_up = {}, .sides_guessed = true});
        EXPECT_LT(degrees_off(frame.axes[2], {0, 0, 1}), 1);
        EXPECT_THAT(frame.note, testing::HasSubstr("up (--up)"));
    }
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
