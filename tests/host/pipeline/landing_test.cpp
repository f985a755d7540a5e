// SPDX-License-Identifier: MIT
#include "safety/landing.h"

#include "assessed_room.h"
#include "clouds.h"
#include "device/devices.h"
#include "host/pipeline/scan.h"
#include "lab/solids/ray_caster.h"
#include "objects/legs.h"
#include "physics/directions.h"
#include "safety/earthquake/earthquake_field.h"
#include "safety/find_fastenings.h"
#include "safety/human/human_field.h"

namespace topple::test {
namespace {

class Landings : public ::testing::Test {
  protected:
    std::vector<Landing> of(Room& room) {
        scene = std::make_unique<AssessedRoom>(*device, room, 0.3);
        return landings(scene->parts, scene->stage);
    }
    std::vector<double> shares(const std::vector<Landing>& landings) {
        std::vector<safety::FallZone> zones;
        for (const Landing& landing : landings) zones.push_back(landing.zone);
        return safety::human_field(*device, scene->around, scene->at_risk, {})
            .passing_shares(zones);
    }
    std::unique_ptr<device::Device> device = device::open_native(2);
    std::unique_ptr<AssessedRoom> scene;
};

TEST_F(Landings, APostReachesAsFarAsItIsHigh) {
    Room room(0.025, {-2, -2}, {2, 2});
    const auto post = static_cast<std::size_t>(room.box(0, 0.1, -0.2, 0.2, 0, 1, false));
    const Landing landing = of(room)[post];
    EXPECT_NEAR(std::abs(landing.zone.way[0]), 1, 0.05) << "over a long edge";
    EXPECT_NEAR(landing.zone.ahead_m, 1.05, 0.06) << "from its middle to where its top lies";
    EXPECT_NEAR(landing.zone.left_m, 0.2, 0.05);
    EXPECT_NEAR(landing.zone.right_m, 0.2, 0.05);
    EXPECT_NEAR(landing.zone.lowest_m, 0, 0.05);
    EXPECT_NEAR(landing.zone.highest_m, 1, 0.05);
    // From standing on its edge to lying on its side.
    const double mass = scene->at_risk[post].mass_kg;
    EXPECT_NEAR(landing.hits_J, mass * 9.80665 * (std::hypot(0.5, 0.05) - 0.05),
                0.15 * landing.hits_J);
}

TEST_F(Landings, WhatFallsOffATableSweepsDownToTheFloor) {
    Room room(0.025, {-2, -2}, {2, 2});
    room.box(-0.5, 0.5, -0.5, 0.5, 0.7, 0.75);
    const auto cup = static_cast<std::size_t>(room.box(0.4, 0.5, -0.05, 0.05, 0.75, 0.9, false));
    const Landing landing = of(room)[cup];
    const double mass = scene->at_risk[cup].mass_kg;
    EXPECT_NEAR(landing.zone.lowest_m, 0, 0.05);
    EXPECT_GE(landing.hits_J, mass * 9.80665 * 0.7);
    EXPECT_LT(landing.hits_J, mass * 9.80665 * 0.9);
    EXPECT_GT(landing.zone.ahead_m, 0.1);
}

TEST_F(Landings, WhatAWallStopsHitsItWithLess) {
    double free_J = 0;
    for (const bool wall : {false, true}) {
        Room room(0.025, {-2, -2}, {2, 2});
        if (wall) {
            room.box(0.3, 0.4, -2, 2, 0, 2.5);
            room.box(-0.4, -0.3, -2, 2, 0, 2.5);
        }
        const auto post = static_cast<std::size_t>(room.box(-0.05, 0.05, -0.3, 0.3, 0, 1, false));
        const Landing landing = of(room)[post];
        EXPECT_EQ(landing.swept.stopped, wall);
        if (wall) {
            EXPECT_GT(landing.hits_J, 0);
            EXPECT_LT(landing.hits_J, 0.5 * free_J);
        }
        free_J = landing.hits_J;
    }
}

// A wall of the building does not give way: what leans on it releases what it hits it with, and
// what leans on it before it is over its edge releases nothing. A cupboard that is not the
// building's may give way.
TEST_F(Landings, WhatTheBuildingStopsReleasesWhatItHitsWith) {
    const auto falls = [&](bool building, double gap) {
        Room room(0.025, {-2, -2}, {2, 2});
        for (const double x : {0.05 + gap, -0.15 - gap})
            room.box(x, x + 0.1, -0.5, 0.5, 0, 1.5, building);
        const auto post = static_cast<std::size_t>(room.box(-0.05, 0.05, -0.3, 0.3, 0, 1, false));
        const Landing landing = of(room)[post];
        EXPECT_TRUE(landing.easiest.stopped);
        const physics::Instability& how = scene->objects[post].instability;
        EXPECT_GT(how.barrier_J, 0);
        EXPECT_EQ(landing.on_easiest, how.release_J > 0);
        if (landing.on_easiest) {
            EXPECT_LE(landing.hits_J, how.release_J);
        } else {  // what is told of its fall is that over one of its ends
            EXPECT_GT(std::abs(landing.zone.way[1]), 0.9);
        }
        return how;
    };
    const physics::Instability beside_building = falls(true, 0.25),
                               beside_thing = falls(false, 0.25);
    EXPECT_EQ(beside_building.barrier_J, beside_thing.barrier_J);
    EXPECT_GT(beside_building.release_J, 0);
    EXPECT_LT(beside_building.release_J, 0.5 * beside_thing.release_J);
    // Over its ends it falls as before.
    EXPECT_NEAR(beside_building.curve.back().S_J, beside_thing.curve.back().S_J,
                0.3 * beside_thing.curve.back().S_J);
    const physics::Instability close = falls(true, 0.05);
    EXPECT_EQ(close.barrier_J, beside_building.barrier_J);
    EXPECT_EQ(close.release_J, 0) << "it leans before it is over its edge";
}

// A step of the building where its top comes down is no wall to lean on.
TEST_F(Landings, WhatMeetsSomethingLowFallsFlat) {
    Room room(0.025, {-2, -2}, {2, 2});
    room.box(0.85, 1.3, -0.5, 0.5, 0, 0.075);
    room.box(-1.3, -0.85, -0.5, 0.5, 0, 0.075);
    const auto post = static_cast<std::size_t>(room.box(-0.05, 0.05, -0.3, 0.3, 0, 1, false));
    const Landing landing = of(room)[post];
    EXPECT_NEAR(std::abs(landing.zone.way[0]), 1, 0.05);
    EXPECT_FALSE(landing.swept.stopped);
    EXPECT_EQ(landing.swept.by, -1);
    EXPECT_LT(landing.swept.center[2], 0.1);
    EXPECT_GT(landing.swept.center[2], 0.051) << "it lies on the step";
}

TEST_F(Landings, MorePeopleMeetWhatStandsByTheWay) {
    Room room(0.025, {-2, -2}, {2, 2});
    const auto middle = static_cast<std::size_t>(room.box(0, 0.1, 0, 0.4, 0, 1, false));
    const auto corner = static_cast<std::size_t>(room.box(1.9, 2, 1.6, 2, 0, 1, false));
    const auto landings = of(room);
    const auto share = shares(landings);
    ASSERT_EQ(share.size(), landings.size());
    EXPECT_GT(share[middle], share[corner]);
    EXPECT_GT(share[middle], 0.2);
    EXPECT_EQ(share[0], 0) << "the ground does not fall";
}

// A table top that nothing was seen to hold, with a post below it that ends `gap` under it.
std::int32_t leg_of(double gap, bool held, double width = 0.1, bool between = false) {
    const auto device = device::open_native(1);
    Room room(0.025, {-1, -1}, {1, 1});
    const auto post = room.box(0, width, 0, 0.1, 0, 0.9 - gap, false);
    const auto top = room.box(-0.6, 0.6, -0.6, 0.6, 0.9, 0.95, false);
    if (between) room.box(-0.1, 0.2, -0.1, 0.2, 0.85, 0.875, false);
    AssessedRoom scene(*device, room, 0.3);
    auto& rest = scene.objects[top].rest;
    rest = held ? graph::RestKind::seen : graph::RestKind::hidden;
    const auto legs = find_legs(scene.solids, room.object_of_primitive, scene.objects);
    EXPECT_EQ(legs.size(), scene.objects.size());
    EXPECT_EQ(legs[top], -1);
    const std::int32_t found = legs[post];
    return found == top ? 1 : found;
}

TEST(Legs, AreSlimAndReachMostOfTheWayToWhatNothingHolds) {
    EXPECT_EQ(leg_of(0.15, false), 1);
    EXPECT_EQ(leg_of(0.025, false), 1);
    EXPECT_EQ(leg_of(0.3, false), -1) << "it ends far below";
    EXPECT_EQ(leg_of(0.15, true), -1) << "the top stands on something else";
    EXPECT_EQ(leg_of(0.15, false, 0.3), -1) << "a box";
    EXPECT_EQ(leg_of(0.15, false, 0.1, true), -1) << "something lies between";
}

Fastening fastening(bool wall, double wall_m = 0.2) {
    const auto device = device::open_native(1);
    Room room(0.025, {-2, -2}, {2, 2});
    if (wall) room.box(0.4 + wall_m, 0.7 + wall_m, -1, 1, 0, 2.5);
    const auto shelf = static_cast<std::size_t>(room.box(0, 0.4, -0.5, 0.5, 0, 1.8, false));
    const AssessedRoom scene(*device, room, 0.3);
    return find_fastenings(scene.parts, scene.stage)[shelf];
}

TEST(Fastenings, AreToWallsWithinReach) {
    EXPECT_TRUE(fastening(true).wall);
    EXPECT_TRUE(fastening(true).floor);
    EXPECT_FALSE(fastening(true, 0.5).wall);
    EXPECT_FALSE(fastening(false).wall) << "the floor is none";
}

// Laser stations that don't see all of what carries things.

scenes::Part block(const Vec3& low, const Vec3& high) {
    scenes::Part part;
    for (std::size_t a = 0; a < 3; ++a) {
        part.center[a] = (low[a] + high[a]) / 2;
        part.size[a] = high[a] - low[a];
    }
    return part;
}

constexpr double thick_m = 0.04, under_m = 0.43, top_m = 0.47;

// A corner of a room; a low table with a carton on it, before which both stations stand: its top
// hides a leg from them, and the carton hides some of its top.
std::vector<scenes::Part> room() {
    std::vector<scenes::Part> out{
        block({0, 0, -0.1}, {2.4, 2, 0}), block({-0.1, 0, 0}, {0, 2, 1.7}),
        block({0, -0.1, 0}, {2.4, 0, 1.7}), block({1.18, 0.6, under_m}, {2.02, 1.1, top_m}),
        block({1.5, 0.74, top_m}, {1.7, 0.9, top_m + 0.3})};
    for (const double x : {1.2, 1.96})
        for (const double y : {0.62, 1.04})
            out.push_back(block({x, y, 0}, {x + thick_m, y + thick_m, under_m}));
    return out;
}

PointCloud scanned(const std::vector<scenes::Part>& parts) {
    const scenes::RayCaster caster(parts);
    constexpr double step = 0.5 * std::numbers::pi / 180;
    PointCloud out;
    for (const Vec3& eye : {Vec3{0.3, 1.6, 1.3}, Vec3{2, 1.7, 1.4}}) {
        for (double azimuth = 0; azimuth < 2 * std::numbers::pi; azimuth += step) {
            for (double up = -1.4; up < 0.8; up += step) {
                const Vec3 d{std::cos(azimuth) * std::cos(up), std::sin(azimuth) * std::cos(up),
                             std::sin(up)};
                const auto hit = caster.cast(eye, d);
                if (hit.part < 0) continue;
                test::add(out, eye[0] + hit.distance * d[0], eye[1] + hit.distance * d[1],
                          eye[2] + hit.distance * d[2]);
                out.viewpoint_x.push_back(static_cast<float>(eye[0]));
                out.viewpoint_y.push_back(static_cast<float>(eye[1]));
                out.viewpoint_z.push_back(static_cast<float>(eye[2]));
            }
        }
    }
    return out;
}

double tipping_J(double mass_kg, double height_m, double margin_m) {
    return mass_kg * 9.80665 * (std::hypot(height_m, margin_m) - height_m);
}

TEST(UnseenLeg, WhatNoStationSawMayCarry) {
    const Scene scene = parse(scanned(room()), on(device::open_device("native"))).scene;
    const Object* table = movable_at(scene, {1.6, 0.85, 0.4}, 0.15);
    const Object* carton = movable_at(scene, {1.6, 0.82, 0.62}, 0.15);
    ASSERT_NE(table, nullptr);
    ASSERT_NE(carton, nullptr);
    const double of_top = 0.84 * 0.5 * thick_m, of_legs = 4 * thick_m * thick_m * under_m;
    const double height =
        (of_top * (under_m + thick_m / 2) + of_legs * under_m / 2) / (of_top + of_legs);
    const double right = tipping_J(700 * (of_top + of_legs), height, 0.22);
    EXPECT_NEAR(table->barrier_J, right, 2 * table->barrier_error_J) << table->why.sentence;
    EXPECT_GT(table->barrier_J, right / 2) << "of three legs: a fifteenth";
    EXPECT_NE(table->advice.kind, "fix") << table->advice.sentence;
    EXPECT_NEAR(carton->barrier_J, tipping_J(700 * 0.2 * 0.16 * 0.3, 0.15, 0.08), 0.3)
        << carton->why.sentence;
    EXPECT_EQ(carton->mode, "tip");
}

}  // namespace
}  // namespace topple::test

namespace topple::safety {
namespace {

constexpr double mu = 0.3, gravity = 9.80665;

// A flat box by the edge of a table, which lies beyond it towards +x: a pulse that throws it there
// or nearly there pushes it off; one that throws it along the edge, or away from it, does not.
TEST(TableEdge, WhatSlidesAlongItStaysOn) {
    const auto device = device::open_native(1);
    test::Room room(0.02, {0, 0}, {3, 3});
    room.box(0.2, 1.4, 0.2, 2.8, 0, 0.4);
    const auto id = static_cast<std::size_t>(room.box(1.2, 1.36, 1.42, 1.58, 0.4, 0.44, false));
    const test::AssessedRoom scene(*device, room, mu);
    const double needs =
        slide_towards_m(scene.at_risk[id], {1, 0, 0}, 0);  // its centre is 12 cm from the edge
    ASSERT_NEAR(needs, 0.12, 0.021);
    // Newmark's s = (a - mu g) a t^2 / (2 mu g) is half as far again.
    const double a = 5, t = std::sqrt(1.5 * needs * 2 * mu * gravity / ((a - mu * gravity) * a));
    EarthquakeOptions options;
    Accelerogram pulse;
    pulse.step_s = t / 100;
    pulse.m_s2.assign(200, 0.0);
    std::fill_n(pulse.m_s2.begin(), 100, a);
    options.record = pulse;
    const Disturbance field = earthquake_field(*device, scene.around, scene.at_risk, options);
    ASSERT_EQ(field.work[id].size(), direction_count);
    for (unsigned d = 0; d < direction_count; ++d) {
        SCOPED_TRACE(d);
        const bool falls = instability(scene.at_risk[id], field.work[id][d]) > 0;
        const double towards = direction(d)[0];
        EXPECT_EQ(falls, 1.5 * towards > 1) << towards;
    }
}

}  // namespace
}  // namespace topple::safety
