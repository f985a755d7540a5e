// SPDX-License-Identifier: MIT
#include "core/json.h"
#include "export/writers.h"
#include "host/export/shapes_scene.h"
#include "host/io/files.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "mujoco/main/settle.h"
#include "mujoco/verdict.h"
#include "topple/parse.h"

// Exports as MuJoCo reads and runs them.
namespace topple::exports::test {
namespace {

class ExportStands : public topple::test::Files {
  protected:
    // What MuJoCo makes of it, and how many of its free bodies stay for so long, or were ever
    // faster than a metre a second.
    struct Stay {
        mujoco::Settled settled;
        std::ptrdiff_t free = 0, stay = 0, launched = 0;
    };
    Stay run(const std::string& file, double seconds) const {
        Stay out{mujoco::settle(path(file), seconds)};
        EXPECT_EQ(out.settled.problem, "") << file;
        const auto& motions = out.settled.motions;
        out.free = std::ssize(motions);
        out.stay = std::ranges::count_if(motions, &mujoco::Motion::stays);
        out.launched = std::ranges::count_if(
            motions, [](const mujoco::Motion& each) { return each.fastest_m_s > 1; });
        return out;
    }
};

// With what is seen of them, as MJCF and as URDF.
TEST_F(ExportStands, EveryShapeRests) {
    const SimScene scene = shapes_scene();
    write_mjcf(path("out"), scene);
    write_urdf(path("out"), scene);
    // As URDF, which knows no contact parameters, one of them turns by some degrees on its side.
    for (const auto& [file, least] : {std::pair("out/scene.xml", 6), {"out/scene.urdf", 5}}) {
        const Stay stay = run(file, 1);
        EXPECT_LT(stay.settled.deepest_m, 0.0006);
        EXPECT_EQ(stay.free, 6) << file;
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
    for (std::int32_t n : {0, 1}) scene.bodies[n].object = n;
    write_mjcf(path("out"), scene);
    EXPECT_EQ(run("out/scene.xml", 2).stay, 0);
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
    write_mjcf(path("out"), sim_scene(result.scene, *result.solids, false, true, 0));
    const Stay stay = run("out/scene.xml", 2);
    EXPECT_LT(stay.settled.deepest_m, 0.0005);
    std::printf("%td of %td stay, %td launched\n", stay.stay, stay.free, stay.launched);
    EXPECT_GT(stay.free, 5);
    EXPECT_GE(double(stay.stay), 0.85 * double(stay.free));
    // What is likelier than not a piece of another thing, and said to be, may stand on nothing.
    const auto pieces = std::ranges::count_if(result.scene.objects,
                                              [](const Object& o) { return o.piece_of >= 0; });
    EXPECT_LE(stay.launched, std::min<std::ptrdiff_t>(pieces, 1));
}

}  // namespace
}  // namespace topple::exports::test

// What a run in a simulator says about what a parse says; no simulator is needed for that.
namespace topple::mujoco::test {
namespace {

Object object(std::int32_t id, double barrier_J, double error_J, double release_J) {
    Object out;
    out.id = id;
    out.barrier_J = barrier_J;
    out.barrier_error_J = error_J;
    out.release_J = release_J;
    return out;
}

// The ground; one that stays as said; one that falls as said; one that moves unlike said; one that
// nobody can tell; one that is held; one with nothing to release; one that is in no export.
struct Room {
    Scene scene;
    ExportSummary exported;
    Settled run;
    Room() {
        scene.objects = {object(0, 0, 0, 0),   object(1, 2, 0.1, 3),   object(2, 0, 0.1, 1),
                         object(3, 1, 0.1, 1), object(4, 0.1, 0.2, 1), object(5, 1, 0, 1),
                         object(6, 0, 0.1, 0), object(7, 1, 0.1, 1)};
        scene.objects[0].grounded = true;
        for (const Object& o : scene.objects) {
            ExportedBody body;
            body.object = o.id;
            body.name = "object_" + std::to_string(o.id);
            body.held = o.id == 5;
            body.parts = o.id == 7 ? 0 : 1;
            exported.bodies.push_back(body);
        }
        exported.bodies.push_back({});
        run.version = "2.2.2";
        run.simulated_s = 5;
        run.wall_s = 2.5;
        run.motions = {{"object_1", 0.001, 0.1, 0.01}, {"object_2", 0.4, 80, 1.5},
                       {"object_3", 0.001, 30, 0.5},   {"object_4", 0.02, 1, 0.2},
                       {"object_6", 0, 0, 0},          {"pad_7", 1, 1, 1}};
    }
};

TEST(Verdict, SaysWhereBothAgree) {
    const Room room;
    const Verdict verdict = judge(room.scene, room.exported, room.run, 5);
    ASSERT_EQ(verdict.objects.size(), 6u);
    const auto agrees = [&](std::size_t n) { return verdict.objects[n - 1].agrees(); };
    EXPECT_EQ(agrees(1), true);
    EXPECT_EQ(agrees(2), true);
    EXPECT_EQ(agrees(3), false);
    EXPECT_EQ(agrees(4), std::nullopt);
    EXPECT_EQ(agrees(5), std::nullopt);
    EXPECT_EQ(agrees(6), true);
    EXPECT_EQ(verdict.count(Says::stable).free, 3u);
    EXPECT_EQ(verdict.count(Says::stable).stay, 2u);
    EXPECT_EQ(verdict.count(Says::falls).stay, 0u);
    EXPECT_EQ(verdict.count().free, 5u);
    EXPECT_EQ(verdict.count().stay, 2u);
}

TEST(Verdict, IsToldAsTextAndJson) {
    const Room room;
    const Verdict verdict = judge(room.scene, room.exported, room.run, 5);
    const auto json = Json::parse(verdict_json(verdict));
    EXPECT_EQ(json.at("simulator"), "MuJoCo 2.2.2");
    EXPECT_EQ(json.at("real_time_factor"), 2.0);
    EXPECT_EQ(json.at("counts").at("stable").at("stay"), 2);
    EXPECT_EQ(json.at("objects").at(2).at("agrees"), false);
    EXPECT_TRUE(json.at("objects").at(3).at("agrees").is_null());
    EXPECT_FALSE(json.at("objects").at(4).at("free").get<bool>());
    const std::string text = verdict_text(verdict);
    EXPECT_TRUE(text.starts_with("MuJoCo 2.2.2: 2 of 5 objects stay within 1 cm")) << text;
    EXPECT_NE(text.find("disagrees"), std::string::npos);
    EXPECT_NE(text.find("\nheld"), std::string::npos);
}

TEST(Verdict, SaysWhatARunLeftOut) {
    Room room;
    room.run.cut_short = "it became unstable";
    room.run.left_out = 3;
    room.run.motions[0].moved_m = std::nan("");
    const Verdict verdict = judge(room.scene, room.exported, room.run, 5);
    EXPECT_FALSE(verdict.objects[0].stays());
    EXPECT_TRUE(Json::parse(verdict_json(verdict)).at("objects").at(0).at("moved_m").is_null());
    const std::string text = verdict_text(verdict);
    EXPECT_NE(text.find("it became unstable"), std::string::npos);
    EXPECT_NE(text.find("no room for all contacts"), std::string::npos);
    EXPECT_THROW(check_stable(verdict, "room"), Error);
    room.run.cut_short = "it took longer than it may";
    EXPECT_NO_THROW(check_stable(judge(room.scene, room.exported, room.run, 5), "room"));
}

}  // namespace
}  // namespace topple::mujoco::test
