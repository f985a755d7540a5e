// SPDX-License-Identifier: MIT
#include "assessed_room.h"
#include "device/devices.h"
#include "result/explanations.h"
#include "result/sentences.h"
#include "safety/advise.h"
#include "safety/earthquake/earthquake_field.h"
#include "safety/human/human_field.h"
#include "safety/wind/wind_field.h"
#include "testing.h"

namespace topple {
namespace {

// What is said of object 0, beside object 1, whose primitive 0 is part of the building.
struct Said {
    Body body;
    ObjectStage objects;
    Scene scene;
    Role role = Role::wall;
    std::vector<Landing> landings = std::vector<Landing>(2);

    Said() {
        body.candidate.support_polygon = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        scene.voxel_size_m = 0.02;
        scene.objects.resize(2);
        scene.objects[0].id = 0;
        scene.objects[1].id = 1;
        scene.primitives.resize(2);
        scene.primitives[0].object = 1;
        scene.primitives[1].object = 0;
        objects.object_of_primitive = {1, 0};
    }
    std::string sentence() {
        objects.objects = {body, Body{}};
        geometry::SceneFrame frame{};
        frame.axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        explain(objects, ToInput(frame), scene);
        SolidParts parts;
        parts.solids =
            std::make_shared<const SolidScene>(SolidCells{}, std::vector<Role>{role, Role::none});
        write_reasons(parts, objects, landings, scene);
        return scene.objects[0].why.sentence;
    }
};

// An object whose centre of mass lies 0.25 m west of what carries it, with the given barrier; where
// it is stopped on its way, by object 1.
std::string sentence_of_leaning(double barrier_J, double error_J, bool stopped = false,
                                bool building = false,
                                const std::vector<InstabilityStep>& steps = {}) {
    Said said;
    said.body.tipping.margin_m = -0.25;
    said.body.instability.mode = physics::Instability::Mode::tip;
    said.body.instability.weakest = {-1, 0, 0};
    said.body.instability.edge = physics::Ends{Vec3{0, 0, 0}, Vec3{0, 1, 0}};
    said.scene.objects[1].grounded = building;
    Object& object = said.scene.objects[0];
    object.fall.hits_J = 0.004;
    object.barrier_J = barrier_J;
    object.barrier_error_J = error_J;
    object.release_J = steps.empty() ? 300 : 0;
    object.instability = steps;
    object.mode = "tip";
    said.landings[0].easiest.stopped = stopped;
    said.landings[0].easiest.by = stopped ? 0 : -1;
    said.landings[0].for_good = building;
    return said.sentence();
}

TEST(Explain, what_takes_energy_to_go_does_not_fall_as_it_stands) {
    const std::string falls = sentence_of_leaning(0, 5);
    EXPECT_TRUE(falls.starts_with("Falls to the west as it stands: its centre of mass is 0.25 m"))
        << falls;
    for (const double error : {5.0, 500.0}) {
        const std::string tips = sentence_of_leaning(127.5, error);
        EXPECT_EQ(tips.find("as it stands"), std::string::npos) << tips;
        EXPECT_NE(tips.find("is 0.25 m beyond the edge"), std::string::npos) << tips;
        EXPECT_NE(tips.find(error < 127 ? "long, at 128 J" : "long, at between 0 and 628 J"),
                  std::string::npos)
            << tips;
    }
}

TEST(Explain, what_comes_to_lean_does_not_release_what_a_fall_would) {
    const std::string leans = sentence_of_leaning(127.5, 5, true);
    EXPECT_NE(leans.find("; comes to lean on object 1, with 4.0 mJ. If that gave way it would come "
                         "to rest lower and release 300 J, which its risk reckons with."),
              std::string::npos)
        << leans;
    EXPECT_EQ(sentence_of_leaning(127.5, 5).find("lean on"), std::string::npos);
    const std::string on_wall = sentence_of_leaning(127.5, 5, true, true);
    EXPECT_NE(on_wall.find("; comes to lean on a wall, with 4.0 mJ."), std::string::npos)
        << on_wall;
    EXPECT_EQ(on_wall.find("gave way"), std::string::npos) << on_wall;
}

// Its risk is of the harder way.
TEST(Explain, what_the_wall_stops_tells_of_the_harder_way_first) {
    const std::string on_wall =
        sentence_of_leaning(5, 0.5, true, true, {{5, 0}, {6, 200}, {9, 349}});
    EXPECT_TRUE(
        on_wall.starts_with("With 6.0 J or more it may fall and release up to 349 J. "
                            "The easiest way: its centre of mass is 0.25 m beyond"))
        << on_wall;
    EXPECT_TRUE(on_wall.ends_with("before it has come so far: it releases nothing.")) << on_wall;
    const std::string never = sentence_of_leaning(5, 0.5, true, true, {{5, 0}});
    EXPECT_TRUE(never.starts_with("Its centre of mass")) << never;
}

// Floors of scans are not quite level: what slides on one does not fall off it.
TEST(Explain, what_slides_on_the_floor_falls_off_no_floor) {
    const auto sentence_of_slide = [](double drop_m) {
        Said said;
        said.role = Role::floor;
        said.body.tipping.margin_m = 0.25;
        said.body.instability.mode = physics::Instability::Mode::slide;
        said.body.instability.weakest = {1, 0, 0};
        said.body.instability.drop_m = drop_m;
        said.body.instability.onto = 0;
        said.body.sliding.distance_m = 0.12;
        graph::Carrying on_floor;
        on_floor.supporter = 0;
        on_floor.supported = 1;
        on_floor.area_m2 = 0.1;
        said.objects.contacts.carryings = {on_floor};
        said.scene.objects[1].grounded = true;
        Object& chair = said.scene.objects[0];
        chair.why.stands_on = {1};
        chair.mode = "slide";
        chair.barrier_J = 5;
        chair.release_J = 2;
        return said.sentence();
    };
    EXPECT_EQ(
        sentence_of_slide(0.04),
        "Slides to the east on the floor at 5.0 J, over 0.12 m, to where it stands 4.0 cm lower, "
        "and releases 2.0 J.");
    EXPECT_EQ(
        sentence_of_slide(1.2),
        "Slides to the east off the floor at 5.0 J, over 0.12 m; falls 1.2 m to the floor and "
        "releases 2.0 J.");
}

// What is advised of an object of 20 kg that must be held by so much at this height.
std::string fixing(
    const safety::Push& hold,
    const std::function<void(Object&, Suggestion&)>& but = [](Object&, Suggestion&) {}) {
    Scene scene;
    scene.objects.resize(2);
    scene.objects[1].id = 1;
    Object& object = scene.objects[0];
    object.mass_kg = 20;
    object.risk_J = {{"earthquake", 1}};
    std::vector<Suggestion> suggestions(2);
    suggestions[0].kind = Suggestion::Kind::fix;
    suggestions[0].hold = hold;
    but(object, suggestions[0]);
    write_advice(suggestions, scene);
    return object.advice.sentence;
}

// A fixing's force, in what straps are sold by.
TEST(Explain, straps_are_told_by_what_they_carry) {
    EXPECT_EQ(fixing({3.61, 1.5}),
              "Fasten it to the wall or to what carries it, with a strap or bracket rated for 1 kg "
              "or more (it must hold 3.7 N sideways at least, without a margin), at its top, 1.5 m "
              "above what it stands on.");
    EXPECT_THAT(fixing({97.2, 1.5}),
                testing::HasSubstr("rated for 10 kg or more (it must hold 98 N"));
    EXPECT_THAT(fixing({99, 1.5}), testing::HasSubstr("rated for 20 kg"));
    EXPECT_THAT(fixing({2500, 1.5}),
                testing::StartsWith("Ask someone who does such work: fasten it to the wall"));
    EXPECT_EQ(fixing({0, 1.5}), "Fasten it to the wall or to what carries it.");
}

// What one asks before one fastens it: against what, to what, and with how many brackets.
TEST(Explain, a_fixing_is_told_with_its_reason_and_what_it_goes_to) {
    const auto of_shelf = [](const Fastening& to, double mass_kg = 20, std::int32_t leg_of = -1,
                             double width_m = 1.9) {
        return fixing({154, 1.7}, [&](Object& shelf, Suggestion& what) {
            shelf.size_m = {0.4, width_m, std::min(width_m, 1.7)};
            shelf.mass_kg = mass_kg;
            what.hold_against = "human";
            what.fasten = to;
            what.leg_of = leg_of;
        });
    };
    EXPECT_EQ(of_shelf({}),
              "Fasten it to the wall or to what carries it, with two straps or brackets, at studs "
              "of the wall, each rated for 20 kg or more (together they must hold 154 N sideways "
              "at least, the push of a person who walks into it, without a margin), at its top, "
              "1.7 m above what it stands on.");
    EXPECT_EQ(of_shelf({.wall = false, .floor = true}),
              "Take it out, or bolt it to the floor: at its top, 1.7 m above what it stands on, it "
              "must be held against 154 N sideways at least, the push of a "
              "person who walks into it, without a margin.");
    // A chair.
    EXPECT_EQ(of_shelf({.wall = false, .floor = true}, 8, -1, 0.9),
              "Move it to where nobody passes and it stands level, or take it out.");
    EXPECT_THAT(of_shelf({.wall = false, .floor = true}, 25, -1, 0.9),
                testing::HasSubstr("bolt it to the floor"));
    EXPECT_THAT(of_shelf({}, 2, 1),
                testing::StartsWith("Look first: this may be a leg of object 1. If it is none: "
                                    "fasten it, with two straps"));
    // On a table, away from walls.
    EXPECT_THAT(of_shelf({.wall = false, .floor = false}),
                testing::StartsWith("Fasten it to what carries it, with a strap or bracket rated"));
}

}  // namespace
}  // namespace topple

namespace topple::test {
namespace {

constexpr double advice_friction = 0.3, advice_tolerable_J = 0.1;

// All fields of a room, and what is advised.
class Advice : public ::testing::Test {
  protected:
    std::vector<Suggestion> of(Room& room) {
        scene = std::make_unique<AssessedRoom>(*device, room, advice_friction);
        safety::HumanOptions walking;
        walking.paths = 200;
        const std::vector<safety::Disturbance> fields{
            safety::human_field(*device, scene->around, scene->at_risk, walking),
            safety::wind_field(*device, scene->around, scene->at_risk, {}),
            safety::earthquake_field(*device, scene->around, scene->at_risk, {})};
        risk.clear();
        for (const auto& field : fields) risk.push_back(safety::risk(field, scene->at_risk));
        return advise(scene->solids, room.object_of_primitive, scene->objects, scene->at_risk,
                      fields, risk, advice_tolerable_J);
    }
    double worst(std::int32_t id) const {
        double most = 0;
        for (const auto& field : risk) most = std::max(most, field[id].mean_J);
        return most;
    }

    std::unique_ptr<device::Device> device = device::open_native(2);
    std::unique_ptr<AssessedRoom> scene;
    std::vector<std::vector<safety::Risk>> risk;
};

// A heavy flat box that overhangs nothing, 5 cm from the edge of a wide table.
std::int32_t box_on_table(Room& room, double x, double y = 0) {
    room.floor(-2, 2, -2, 2);
    room.box(-0.8, 0.8, -0.8, 0.8, 0.7, 0.75);
    return room.box(x, x + 0.2, y - 0.1, y + 0.1, 0.75, 0.9, false);
}

TEST_F(Advice, WhatIsAtAnEdgeIsMovedInwardsToWhereItIsTolerated) {
    Room room(0.025);
    const auto box = box_on_table(room, 0.575);
    const auto advice = of(room);
    ASSERT_GT(worst(box), advice_tolerable_J);
    const Suggestion& what = advice[box];
    ASSERT_EQ(what.kind, Suggestion::Kind::move);
    EXPECT_LT(what.move_m[0], -0.05) << "away from the edge at x = 0.8";
    EXPECT_LT(std::hypot(what.move_m[0], what.move_m[1]), 0.9);
    EXPECT_LE(what.risk_J, advice_tolerable_J);
    // It keeps what it promises: a box that stands there is tolerated.
    Room moved(0.025);
    const auto there = box_on_table(moved, 0.575 + what.move_m[0], what.move_m[1]);
    of(moved);
    EXPECT_LE(worst(there), advice_tolerable_J);
}

TEST_F(Advice, WhatIsSafeIsLeftAlone) {
    Room room(0.025);
    const auto box = box_on_table(room, -0.1);
    const auto advice = of(room);
    EXPECT_LE(worst(box), advice_tolerable_J);
    EXPECT_EQ(advice[box].kind, Suggestion::Kind::nothing);
}

TEST_F(Advice, ATallThinThingIsFixedAndTheFixingHoldsIt) {
    Room room(0.025, {-2, -2}, {2, 2});
    const auto post = room.box(0, 0.15, 0, 0.15, 0, 1.5, false);
    const auto advice = of(room);
    ASSERT_GT(worst(post), advice_tolerable_J);
    const Suggestion& what = advice[post];
    ASSERT_EQ(what.kind, Suggestion::Kind::fix) << "shaking tips it anywhere";
    EXPECT_NEAR(what.hold.height_m, 1.5, 0.03);
    // 23.6 kg at up to 3 e m/s^2 tip it by (a h - g b) m over its height.
    const double mass = 700 * 0.15 * 0.15 * 1.5;
    EXPECT_GT(what.hold.force_N, mass * (3.0 * 0.75 - 9.80665 * 0.075) / 1.5);
    EXPECT_LT(what.hold.force_N, 1000);
}

TEST_F(Advice, WhatHangsOnNothingSeenIsToBeSeen) {
    Room room(0.025, {-2, -2}, {2, 2});
    const auto lamp = room.box(0, 0.2, 0, 0.2, 1.5, 1.7, false);
    const auto advice = of(room);
    EXPECT_EQ(worst(lamp), 0);
    EXPECT_EQ(advice[lamp].kind, Suggestion::Kind::see);
}

// What is said to upset it would have done so before it was scanned.
TEST(StandsAgainstOdds, WhereTheScanIsReadOneWayOfSeveralOrItWouldNotHaveStood) {
    Body object;
    object.overturning.tilt_deg = 12;
    const auto doubted = [&](double walk, double quake) {
        std::vector<safety::Disturbance> disturbances(2);
        disturbances[0].name = "human";
        disturbances[1].name = "earthquake";
        const std::vector<std::vector<safety::Risk>> risk{{{1, 0, walk}}, {{1, 0, quake}}};
        return stands_against_odds(object, disturbances, risk, 0);
    };
    EXPECT_FALSE(doubted(0.01, 1)) << "it was not scanned in an earthquake";
    EXPECT_TRUE(doubted(0.1, 0));
    object.overturning.tilt_deg = 2;
    EXPECT_TRUE(doubted(0, 0));
    object.overturning.tilt_deg = std::nan("");
    EXPECT_FALSE(doubted(0, 0));
    object.rest_probability = 0.4;
    EXPECT_TRUE(doubted(0, 0));
    object.grounded = true;
    EXPECT_FALSE(doubted(0, 0));
}

}  // namespace
}  // namespace topple::test
