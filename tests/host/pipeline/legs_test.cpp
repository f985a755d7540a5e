// SPDX-License-Identifier: MIT
#include "objects/legs.h"

#include <gtest/gtest.h>

#include "assessed_room.h"
#include "device/devices.h"
#include "safety/find_fastenings.h"

namespace topple::test {
namespace {

// A table top that nothing was seen to hold, with a post below it that ends `gap` under it.
std::int32_t leg_of(double gap, bool held, double width = 0.1, bool between = false) {
    const auto device = device::open_native(1);
    Room room(0.025);
    room.floor(-1, 1, -1, 1);
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
    Room room(0.025);
    room.floor(-2, 2, -2, 2);
    if (wall) room.box(0.4 + wall_m, 0.7 + wall_m, -1, 1, 0, 2.5);
    const auto shelf = static_cast<std::size_t>(room.box(0, 0.4, -0.5, 0.5, 0, 1.8, false));
    AssessedRoom scene(*device, room, 0.3);
    SolidParts parts;
    parts.solids = std::shared_ptr<const SolidScene>(&scene.solids, [](const SolidScene*) {});
    ObjectStage objects;
    objects.objects = scene.objects;
    objects.object_of_primitive = room.object_of_primitive;
    return find_fastenings(parts, objects)[shelf];
}

TEST(Fastenings, AreToWallsWithinReach) {
    EXPECT_TRUE(fastening(true).wall);
    EXPECT_TRUE(fastening(true).floor);
    EXPECT_FALSE(fastening(true, 0.5).wall);
    EXPECT_FALSE(fastening(false).wall) << "the floor is none";
}

}  // namespace
}  // namespace topple::test
