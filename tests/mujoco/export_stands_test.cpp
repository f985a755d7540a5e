// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "core/thread_pool.h"
#include "export/sim_scene.h"
#include "export/writers.h"
#include "host/export/shapes_scene.h"
#include "host/io/files.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "mujoco/running.h"
#include "topple/parse.h"

// Exports as MuJoCo reads and runs them.
namespace topple::exports::test {
namespace {

class ExportStands : public topple::test::Files {};

TEST_F(ExportStands, ABoxOnAFloorHasItsMassItsPlaceAndRests) {
    SimScene scene;
    scene.bodies = {body_of(block({-1, -1, -0.1}, {1, 1, 0}), 0, {}),
                    body_of(block({0, 0, 0}, {0.1, 0.2, 0.4}), 1, {0})};
    scene.bodies[0].object = 0;
    scene.bodies[1].object = 1;
    write_mjcf(path("out"), scene);
    mujoco::Running mujoco(path("out/scene.xml"));
    ASSERT_EQ(mujoco.trouble(), "");
    EXPECT_NEAR(mujoco.mass_kg("object_1"), 700 * 0.008, 1e-9);
    EXPECT_NEAR(mujoco.height_m("object_1"), 0.2, 1e-9);
    EXPECT_TRUE(mujoco.is_box("object_1"));
    const auto stay = mujoco.run(2);
    EXPECT_EQ(stay.free, 1);
    EXPECT_EQ(stay.stay, 1);
}

// With what is seen of them, as MJCF and as URDF.
TEST_F(ExportStands, EveryShapeRests) {
    const SimScene scene = shapes_scene();
    write_mjcf(path("out"), scene);
    write_urdf(path("out"), scene);
    // As URDF, which knows no contact parameters, one of them turns by some degrees on its side.
    for (const auto& [file, least] : {std::pair("out/scene.xml", 5), {"out/scene.urdf", 4}}) {
        mujoco::Running mujoco(path(file));
        ASSERT_EQ(mujoco.trouble(), "") << file;
        EXPECT_NEAR(mujoco.mass_kg("object_2"), 700 * 0.012, 1e-6);
        EXPECT_NEAR(mujoco.height_m("object_2"), 0.3, 1e-6);
        EXPECT_LT(mujoco.deepest_m(), 0.0006);
        const auto stay = mujoco.run(1);
        EXPECT_EQ(stay.free, 5) << file;
        EXPECT_GE(stay.stay, least) << file;
        EXPECT_EQ(stay.launched, 0) << file;
    }
}

TEST_F(ExportStands, WhatLeansTooFarFalls) {
    SimScene scene;
    Body tower = body_of(block({0, 0, 0}, {0.1, 0.1, 0.5}), 1, {0});
    tower.parts.push_back(block({0.1, 0, 0.4}, {0.6, 0.1, 0.5}));
    tower.center_m = {0.2, 0.05, 0.35};
    scene.bodies = {body_of(block({-1, -1, -0.1}, {1, 1, 0}), 0, {}), tower};
    scene.bodies[0].object = 0;
    scene.bodies[1].object = 1;
    write_mjcf(path("out"), scene);
    mujoco::Running mujoco(path("out/scene.xml"));
    ASSERT_EQ(mujoco.trouble(), "");
    EXPECT_EQ(mujoco.run(2).stay, 0);
}

TEST_F(ExportStands, AnotherOnesFileStays) {
    write("out/scene.xml", "<mujoco/>");
    EXPECT_THROW(write_mjcf(path("out"), {}), Error);
}

// A generated room as depth frames show it: nearly all stays, nothing is launched.
TEST_F(ExportStands, SlowAParsedRoomStands) {
    scenes::RoomOptions room;
    room.seed = 5;
    scenes::CameraOptions camera;
    camera.seed = 5;
    camera.frames = 20;
    const scenes::World world = scenes::furnished_room(room);
    scenes::write_sequence(path("scan"), world, scenes::walk(world, camera));
    ParseOptions options;
    options.device = device::open_device("native");
    options.disturbances.clear();
    const ParseResult result = parse(path("scan"), options);
    ThreadPool threads(0);
    write_mjcf(path("out"), sim_scene(result.scene, *result.solids, threads));
    mujoco::Running mujoco(path("out/scene.xml"));
    ASSERT_EQ(mujoco.trouble(), "");
    EXPECT_LT(mujoco.deepest_m(), 0.0005);
    const auto stay = mujoco.run(2);
    std::printf("%d of %d stay, %d launched\n", stay.stay, stay.free, stay.launched);
    EXPECT_GT(stay.free, 5);
    EXPECT_GE(stay.stay, 0.85 * stay.free);
    // What is likelier than not a piece of another thing, and said to be, may stand on nothing.
    const auto pieces = std::ranges::count_if(result.scene.objects,
                                              [](const Object& o) { return o.piece_of >= 0; });
    EXPECT_LE(stay.launched, std::min<std::ptrdiff_t>(pieces, 1));
}

}  // namespace
}  // namespace topple::exports::test
