// SPDX-License-Identifier: MIT
#include "safety/landing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "assessed_room.h"
#include "device/devices.h"
#include "safety/human/human_field.h"

namespace topple::test {
namespace {

class Landings : public ::testing::Test {
  protected:
    std::vector<Landing> of(Room& room) {
        scene = std::make_unique<AssessedRoom>(*device, room, 0.3);
        SolidParts parts;
        parts.solids = std::shared_ptr<const SolidScene>(&scene->solids, [](const SolidScene*) {});
        ObjectStage objects;
        objects.objects = scene->objects;
        objects.object_of_primitive = room.object_of_primitive;
        return landings(parts, objects);
    }
    std::vector<double> shares(const std::vector<Landing>& landings) {
        std::vector<safety::FallZone> zones;
        for (const Landing& landing : landings) zones.push_back(landing.zone);
        return safety::HumanField(*device, scene->around, scene->at_risk, {}).passing_shares(zones);
    }
    std::unique_ptr<device::Device> device = device::open_native(2);
    std::unique_ptr<AssessedRoom> scene;
};

TEST_F(Landings, APostReachesAsFarAsItIsHigh) {
    Room room(0.025);
    room.floor(-2, 2, -2, 2);
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
    Room room(0.025);
    room.floor(-2, 2, -2, 2);
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
        Room room(0.025);
        room.floor(-2, 2, -2, 2);
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
        Room room(0.025);
        room.floor(-2, 2, -2, 2);
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
    Room room(0.025);
    room.floor(-2, 2, -2, 2);
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
    Room room(0.025);
    room.floor(-2, 2, -2, 2);
    const auto middle = static_cast<std::size_t>(room.box(0, 0.1, 0, 0.4, 0, 1, false));
    const auto corner = static_cast<std::size_t>(room.box(1.9, 2, 1.6, 2, 0, 1, false));
    const auto landings = of(room);
    const auto share = shares(landings);
    ASSERT_EQ(share.size(), landings.size());
    EXPECT_GT(share[middle], share[corner]);
    EXPECT_GT(share[middle], 0.2);
    EXPECT_EQ(share[0], 0) << "the ground does not fall";
}

}  // namespace
}  // namespace topple::test
