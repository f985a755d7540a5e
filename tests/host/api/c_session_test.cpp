// SPDX-License-Identifier: MIT
#include <cmath>

#include "core/random.h"
#include "host/api/c_api.h"
#include "host/pipeline/small_walk.h"
#include "topple/session.h"

// Sessions in C are those of C++.
namespace topple::test {
namespace {

// Those that the C sessions here are made with.
SessionOptions same_options() {
    SessionOptions out;
    out.parse.device = device::open_device("native", 2);
    out.parse.disturbances = {};
    out.forget_gone = false;
    return out;
}

TEST_F(CApi, ASessionIsThatOfCpp) {
    const scenes::Sequence walk = small_walk();
    std::vector<topple_frame> images(walk.frames.size());
    std::vector<double> poses;
    for (std::size_t n = 0; n < images.size(); ++n) {
        topple_frame_init(&images[n], sizeof(topple_frame));
        images[n].depth = walk.frames[n].depth.data();
        const Mat4& pose = walk.frames[n].camera_to_world;
        poses.insert(poses.end(), pose.begin(), pose.end());
    }
    const std::vector<double> right = poses;
    poses[3] += 0.2;
    topple_frames frames;
    topple_frames_init(&frames, sizeof(frames));
    frames.intrinsics = {96, 72, 83, 83, 47.5, 35.5, 1000};
    frames.count = images.size();
    frames.camera_to_world = poses.data();
    frames.frames = images.data();
    options.disturbances = 0;

    topple_session* session = nullptr;
    ASSERT_EQ(topple_session_create(&frames.intrinsics, nullptr, &options, 0, 1, &session, &status),
              TOPPLE_OK)
        << status.message;
    topple_thing thing{};
    thing.size = sizeof(thing);
    EXPECT_EQ(topple_session_thing(session, 0, &thing, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_session_update(session, &result, nullptr, &status), TOPPLE_ERROR_INPUT);
    std::vector<std::uint64_t> ids(images.size());
    ASSERT_EQ(topple_session_add(session, &frames, ids.data(), &status), TOPPLE_OK)
        << status.message;
    EXPECT_EQ(ids, (std::vector<std::uint64_t>{0, 1, 2, 3, 4, 5}));
    ASSERT_EQ(topple_session_correct(session, ids.data(), right.data(), 1, &status), TOPPLE_OK);
    ASSERT_EQ(topple_session_forget(session, 5, &status), TOPPLE_OK);
    EXPECT_EQ(topple_session_forget(session, 5, &status), TOPPLE_ERROR_USAGE);
    std::uint64_t things = 0;
    ASSERT_EQ(topple_session_update(session, &result, &things, &status), TOPPLE_OK)
        << status.message;

    Session other(walk.intrinsics, {}, same_options());
    for (std::size_t n = 0; n < 5; ++n)
        other.add(frames_view_of(walk).images[n], walk.frames[n].camera_to_world);
    const auto expected = other.update();
    ASSERT_EQ(things, expected->things.size());
    EXPECT_TRUE(std::ranges::equal(
        expected->result->scene.points.object,
        std::span(topple_result_point_objects(result), expected->result->scene.points.x.size())));
    for (std::uint64_t n = 0; n < things; ++n) {
        ASSERT_EQ(topple_session_thing(session, n, &thing, &status), TOPPLE_OK);
        EXPECT_EQ(thing.id, expected->things[n].id);
        EXPECT_EQ(thing.object, expected->things[n].object);
        EXPECT_EQ(thing.change, TOPPLE_CHANGE_FOUND);
    }
    topple_result* within = nullptr;
    std::uint64_t again = 0;
    ASSERT_EQ(topple_session_update_within(session, UINT64_MAX, &within, &again, &status),
              TOPPLE_OK);
    EXPECT_EQ(again, things);
    topple_result* settled = nullptr;
    ASSERT_EQ(topple_session_cancel(session, &status), TOPPLE_OK);
    ASSERT_EQ(topple_session_settle(session, &settled, &status), TOPPLE_OK) << status.message;
    for (const topple_result* same_result : {within, settled})
        EXPECT_TRUE(std::ranges::equal(expected->result->scene.points.object,
                                       std::span(topple_result_point_objects(same_result),
                                                 expected->result->scene.points.x.size())));
    topple_result_release(within);
    topple_result_release(settled);
    EXPECT_EQ(topple_session_settle(session, nullptr, &status), TOPPLE_ERROR_USAGE);
    frames.camera_to_world = right.data();
    std::vector<std::int64_t> labels(std::size_t{96} * 72);
    ASSERT_EQ(topple_session_label(session, &frames, 1, labels.data(), &status), TOPPLE_OK);
    EXPECT_EQ(labels,
              other.label(frames_view_of(walk).images[1], walk.frames[1].camera_to_world).thing);
    EXPECT_EQ(topple_session_label(session, &frames, 6, labels.data(), &status),
              TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_session_correct(session, nullptr, right.data(), 1, &status),
              TOPPLE_ERROR_USAGE);
    // A checkpoint, and on from there: the same things, by the same ids.
    const std::string file = path("session.checkpoint").string();
    ASSERT_EQ(topple_session_checkpoint(session, file.c_str(), &status), TOPPLE_OK);
    topple_session_release(session);
    EXPECT_EQ(topple_session_checkpoint(nullptr, file.c_str(), &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_session_resume("none", &options, 0, 1, &session, &status), TOPPLE_ERROR_INPUT);
    EXPECT_EQ(session, nullptr);
    ASSERT_EQ(topple_session_resume(file.c_str(), &options, 0, 1, &session, &status), TOPPLE_OK)
        << status.message;
    ASSERT_EQ(topple_session_update_within(session, 0, nullptr, &again, &status), TOPPLE_OK);
    EXPECT_EQ(again, 0u);
    ASSERT_EQ(topple_session_update(session, nullptr, &again, &status), TOPPLE_OK);
    ASSERT_EQ(again, things);
    for (std::uint64_t n = 0; n < things; ++n) {
        ASSERT_EQ(topple_session_thing(session, n, &thing, &status), TOPPLE_OK);
        EXPECT_EQ(thing.id, expected->things[n].id);
        EXPECT_EQ(thing.change, TOPPLE_CHANGE_NONE);
    }
    topple_session_release(session);
    EXPECT_EQ(topple_session_add(nullptr, &frames, nullptr, &status), TOPPLE_ERROR_USAGE);
    topple_session_release(nullptr);
}

TEST_F(CApi, ASessionOfPointsIsThatOfCpp) {
    PointCloud points;
    Random random(3);
    for (int n = 0; n < 60000; ++n) {
        // On the sides of a room, and of a box on its floor.
        Vec3 way{random.normal(), random.normal(), random.normal()};
        const double largest =
            std::max({std::fabs(way[0]), std::fabs(way[1]), std::fabs(way[2]), 1e-9});
        const double half = n % 3 ? 1.5 : 0.4, down = n % 3 ? 0 : -1.1;
        points.x.push_back(static_cast<float>(half * way[0] / largest));
        points.y.push_back(static_cast<float>(half * way[1] / largest));
        points.z.push_back(static_cast<float>(half * way[2] / largest + down));
    }
    topple_cloud cloud;
    topple_cloud_init(&cloud, sizeof(cloud));
    cloud.x = points.x.data();
    cloud.y = points.y.data();
    cloud.z = points.z.data();
    cloud.count = points.size();
    options.disturbances = 0;
    const Mat4 pose = DepthFrame{}.camera_to_world;
    topple_session* session = nullptr;
    ASSERT_EQ(topple_session_create(nullptr, nullptr, &options, 0, 1, &session, &status), TOPPLE_OK)
        << status.message;
    std::uint64_t id = 7, things = 0;
    EXPECT_EQ(topple_session_add_points(session, &cloud, nullptr, &id, &status),
              TOPPLE_ERROR_USAGE);
    ASSERT_EQ(topple_session_add_points(session, &cloud, pose.data(), &id, &status), TOPPLE_OK)
        << status.message;
    EXPECT_EQ(id, 0u);
    ASSERT_EQ(topple_session_update(session, &result, &things, &status), TOPPLE_OK)
        << status.message;
    Session other = Session::of_points(same_options());
    other.add(CloudView(points), pose);
    const auto expected = other.update();
    ASSERT_EQ(things, expected->things.size());
    // A second box comes beside the first one.
    PointCloud more = points;
    for (int n = 0; n < 3000; ++n) {
        const double u = random.uniform(0, 0.4), v = random.uniform(0, 0.4);
        const bool top = n % 2;
        more.x.push_back(static_cast<float>(0.8 + u));
        more.y.push_back(static_cast<float>(top ? 0.8 + v : 0.8));
        more.z.push_back(static_cast<float>(top ? -1.1 : -1.1 - v));
    }
    cloud.x = more.x.data();
    cloud.y = more.y.data();
    cloud.z = more.z.data();
    cloud.count = more.size();
    Mat4 aside = pose;
    aside[3] = 1e-4;
    ASSERT_EQ(topple_session_add_points(session, &cloud, aside.data(), nullptr, &status),
              TOPPLE_OK);
    other.add(CloudView(more), aside);
    std::uint64_t count = 7;
    ASSERT_EQ(topple_session_glance(session, &count, &status), TOPPLE_OK) << status.message;
    const std::vector<Appeared> glanced = other.glance();
    ASSERT_EQ(count, glanced.size());
    topple_appeared appeared{};
    appeared.size = sizeof(appeared);
    EXPECT_EQ(topple_session_appeared(session, count, &appeared, &status), TOPPLE_ERROR_USAGE);
    ASSERT_EQ(count, 1u);
    ASSERT_EQ(topple_session_appeared(session, 0, &appeared, &status), TOPPLE_OK);
    EXPECT_EQ(appeared.mass_kg, glanced[0].mass_kg);
    EXPECT_EQ(appeared.barrier_J, glanced[0].barrier_J);
    EXPECT_EQ(appeared.mode, glanced[0].mode);
    cloud.x = points.x.data();
    cloud.y = points.y.data();
    cloud.z = points.z.data();
    cloud.count = points.size();
    std::vector<std::int64_t> labels(points.size());
    ASSERT_EQ(topple_session_label_points(session, &cloud, pose.data(), labels.data(), &status),
              TOPPLE_OK);
    EXPECT_EQ(labels, other.label(CloudView(points), pose));
    topple_session_release(session);
}

}  // namespace
}  // namespace topple::test
