// SPDX-License-Identifier: MIT
#include "safety/human/walkable_map.h"

#include "physics/directions.h"
#include "room.h"
#include "safety/human/human_field.h"
#include "safety/human/passers_by.h"
#include "testing.h"

namespace topple::safety {
namespace {

std::size_t cell_at(const WalkableMap& map, double x, double y) {
    return static_cast<std::size_t>(static_cast<std::int64_t>((y - map.y0) / map.cell_m) * map.nx +
                                    static_cast<std::int64_t>((x - map.x0) / map.cell_m));
}
bool walkable(const WalkableMap& map, double x, double y) {
    return map.component[cell_at(map, x, y)] >= 0;
}

TEST(WalkableMap, KeepsTheBodyClearOfWhatStandsInItsWay) {
    test::Room room(0.02, {0, 0}, {4, 4});
    room.box(2.0, 2.2, 2.0, 2.2, 0, 1);       // a pillar
    room.box(1.0, 1.2, 1.0, 1.2, 0, 0.04);    // low enough to step over
    room.box(3.0, 3.2, 1.0, 1.2, 1.9, 2.1);   // a lamp above the head
    room.box(3.0, 3.2, 3.0, 3.2, 0.7, 0.74);  // a table top
    const WalkableMap map = walkable_map(room.surroundings(), {});
    EXPECT_FALSE(walkable(map, 2.1, 2.1));
    EXPECT_FALSE(walkable(map, 1.86, 2.1)) << "nearer than the body's radius";
    EXPECT_TRUE(walkable(map, 1.73, 2.1));
    EXPECT_TRUE(walkable(map, 1.1, 1.1));
    EXPECT_TRUE(walkable(map, 3.1, 1.1));
    EXPECT_FALSE(walkable(map, 3.1, 3.1));
    EXPECT_EQ(map.components, 1);
    EXPECT_EQ(map.bridged, 0);
}

TEST(WalkableMap, BridgesSmallHolesOnlyAndSaysSo) {
    test::Room room(0.02, {0, 0}, {4, 2});
    room.remove(0.9, 1.1, 0.9, 1.1, -1, 1);  // 0.2 m
    room.remove(2.4, 3.2, 0.6, 1.4, -1, 1);  // 0.8 m
    const WalkableMap map = walkable_map(room.surroundings(), {});
    EXPECT_TRUE(walkable(map, 1.0, 1.0));
    EXPECT_FALSE(walkable(map, 2.8, 1.0));
    EXPECT_GT(map.bridged, 0);
    ASSERT_EQ(map.notes.size(), 1u);
    EXPECT_THAT(map.notes[0], testing::HasSubstr("bridged"));
}

TEST(WalkableMap, WallsAndStepsSeparate) {
    test::Room room(0.02, {0, 0}, {2, 2});
    room.floor(2, 4, 0, 2, 0.3);  // a stage, too high to step on
    room.box(0, 2, 0.98, 1.02, 0, 2);
    const WalkableMap map = walkable_map(room.surroundings(), {});
    EXPECT_EQ(map.components, 3);
    EXPECT_NE(map.component[cell_at(map, 0.5, 0.5)], map.component[cell_at(map, 0.5, 1.5)]);
    EXPECT_NEAR(map.floor_m[cell_at(map, 3, 1)], 0.3, 1e-6);
}

TEST(WalkableMap, FewStraySpecksDoNotBlock) {
    test::Room room(0.02, {0, 0}, {2, 2});
    const auto speck = room.box(1.0, 1.02, 1.0, 1.02, 1.0, 1.02);
    Surroundings surroundings = room.surroundings();
    EXPECT_FALSE(walkable(walkable_map(surroundings, {}), 1.01, 1.01));
    SolidCells cells = *surroundings.cells;
    for (auto& primitive : cells.primitive) primitive = primitive == speck ? -1 : primitive;
    surroundings.cells = &cells;
    EXPECT_TRUE(walkable(walkable_map(surroundings, {}), 1.01, 1.01));
}

TEST(WalkableMap, SaysWhyNobodyWalks) {
    test::Room room(0.02);
    EXPECT_EQ(walkable_map(room.surroundings(), {}).notes.size(), 1u);
    room.box(0, 1, 0, 1, -0.02, 0);
    EXPECT_THAT(walkable_map(room.surroundings(), {}).notes.at(0), testing::HasSubstr("floor"));
    test::Room full(0.02);
    full.floor(0, 1, 0, 1);
    full.box(0.2, 0.8, 0.2, 0.8, 0.5, 1);
    full.box(0, 1, 0, 1, 0.6, 0.7);
    EXPECT_THAT(walkable_map(full.surroundings(), {}).notes.at(0), testing::HasSubstr("no room"));
}

// A table top that was scanned alone looks like a floor.
TEST(WalkableMap, SaysThatTheFloorIsSmall) {
    const auto says_so = [](double width, double depth) {
        test::Room room(0.02, {0, 0}, {width, depth});
        const WalkableMap map = walkable_map(room.surroundings(), {});
        EXPECT_FALSE(map.walkable.empty());
        return !map.notes.empty() && map.notes.back().find("square metres") != std::string::npos &&
               map.notes.back().find("out of the disturbances") != std::string::npos;
    };
    EXPECT_TRUE(says_so(1.6, 0.8));
    EXPECT_TRUE(says_so(2.4, 1.2));
    EXPECT_FALSE(says_so(2.4, 2.0));
}

TEST(PrimaryMotion, StaysOnWalkableCellsAndCrowdsThePassage) {
    test::Room room(0.02, {0, 0}, {4, 4});
    room.box(0, 1.6, 1.96, 2.04, 0, 2);
    room.box(2.4, 4, 1.96, 2.04, 0, 2);  // a door of 0.8 m between them
    const WalkableMap map = walkable_map(room.surroundings(), {});
    ASSERT_EQ(map.components, 1);
    const PrimaryMotion motion = primary_motion(map, {});
    const auto frequency = [&](std::size_t c) {
        double sum = 0;
        for (unsigned d = 0; d < direction_count; ++d) sum += motion.frequency(d, c, map.size());
        return sum;
    };
    double through_door = 0, most = 0;
    for (std::size_t c = 0; c < map.size(); ++c) {
        EXPECT_LE(frequency(c), 1);
        if (map.component[c] < 0) {
            EXPECT_EQ(frequency(c), 0) << "a walk through cell " << c;
        }
        most = std::max(most, frequency(c));
    }
    const auto row = static_cast<std::int64_t>(2.0 / map.cell_m);
    for (std::int64_t x = 0; x < map.nx; ++x)
        through_door += frequency(static_cast<std::size_t>(row * map.nx + x));
    // Half of all pairs lie on different sides: binomial, 500 trials; a false alarm at 5 sigma.
    EXPECT_NEAR(through_door, 0.5, 0.12);
    EXPECT_GT(most, 5 * frequency(cell_at(map, 0.25, 0.25))) << "a corner is not a passage";
}

TEST(PrimaryMotion, StraightWalksHeadStraight) {
    test::Room room(0.02, {0, 0}, {6, 0.1});  // two cells wide
    const WalkableMap map = walkable_map(room.surroundings(), {});
    const PrimaryMotion motion = primary_motion(map, {});
    std::uint64_t along = 0, other = 0;
    for (unsigned d = 0; d < direction_count; ++d) {
        for (std::size_t c = 0; c < map.size(); ++c)
            (d % 8 == 0 ? along : other) += motion.visits[d * map.size() + c];
    }
    EXPECT_GT(along, 20 * other);
}

// A corridor of 6 x 2 m along x, its floor at 0.
test::Room corridor() {
    test::Room room(0.025, {0, 0}, {6, 2});
    return room;
}

// 0.2 m wide, along y at x = 3, from the wall at y = 0 to y = length.
FallZone across(double length) {
    FallZone zone;
    zone.from = {3, 0, 0.5};
    zone.way = {0, 1, 0};
    zone.ahead_m = length;
    zone.left_m = zone.right_m = 0.1;
    zone.highest_m = 1;
    return zone;
}

std::vector<double> shares(test::Room& room, const std::vector<FallZone>& zones,
                           HumanOptions options = {}) {
    const Surroundings around = room.surroundings();
    const WalkableMap map = walkable_map(around, options);
    return passing_shares(map, primary_motion(map, options), Columns(*around.cells), options,
                          zones);
}

// The share of walks that come within `reach` of a rectangle by points close together on them.
double counted_share(const WalkableMap& map, const PrimaryMotion& motion, double x0, double x1,
                     double y0, double y1, double reach) {
    const auto at = [&](std::uint32_t cell) {
        return std::array{map.x0 + (static_cast<double>(cell % map.nx) + 0.5) * map.cell_m,
                          map.y0 + (static_cast<double>(cell / map.nx) + 0.5) * map.cell_m};
    };
    int passing = 0;
    for (const auto& corners : motion.corners) {
        bool passes = false;
        for (std::size_t leg = 1; leg < corners.size(); ++leg) {
            const auto a = at(corners[leg - 1]), b = at(corners[leg]);
            for (int n = 0; n <= 1000; ++n) {
                const double x = a[0] + (b[0] - a[0]) * n / 1000;
                const double y = a[1] + (b[1] - a[1]) * n / 1000;
                const double dx = std::max({x0 - x, 0.0, x - x1});
                const double dy = std::max({y0 - y, 0.0, y - y1});
                passes = passes || std::hypot(dx, dy) <= reach;
            }
        }
        passing += passes;
    }
    return static_cast<double>(passing) / motion.paths;
}

TEST(PassersBy, AreTheWalksThatComeWithinReach) {
    test::Room room = corridor();
    const HumanOptions options;
    const Surroundings around = room.surroundings();
    const WalkableMap map = walkable_map(around, options);
    const PrimaryMotion motion = primary_motion(map, options);
    ASSERT_EQ(motion.corners.size(), options.paths);
    const std::vector<FallZone> zones{across(0.3), across(0.9), across(1.9)};
    const auto got = passing_shares(map, motion, Columns(*around.cells), options, zones);
    ASSERT_EQ(got.size(), zones.size());
    for (std::size_t n = 0; n < zones.size(); ++n) {
        const double expected =
            counted_share(map, motion, 2.9, 3.1, 0, zones[n].ahead_m, passing_reach_m);
        EXPECT_NEAR(got[n], expected, 0.03) << "one map cell more or less of reach";
        EXPECT_GT(got[n], n > 0 ? got[n - 1] : 0) << "what falls further meets more";
    }
    EXPECT_GT(got.back(), 0.5) << "all who go from one half to the other";
}

TEST(PassersBy, AWallKeepsThemApart) {
    for (const bool wall : {false, true}) {
        test::Room room = corridor();
        if (wall) room.box(0, 6, 2.0, 2.1, 0, 2.5);
        // Behind it, near enough to be reached.
        FallZone zone = across(0.4);
        zone.from = {2.8, 2.2, 0.5};
        zone.way = {1, 0, 0};
        zone.right_m = 0.15;
        EXPECT_EQ(shares(room, {zone})[0] > 0, !wall);
    }
}

TEST(PassersBy, WhatStaysAboveOrBelowThemMeetsNobody) {
    test::Room room = corridor();
    FallZone above = across(1), below = across(1), beside = across(1);
    above.lowest_m = 1.85;
    above.highest_m = 2.2;
    below.lowest_m = -2;
    below.highest_m = -0.5;
    beside.lowest_m = 1.7;
    beside.highest_m = 2.2;
    const auto got = shares(room, {above, below, beside});
    EXPECT_EQ(got[0], 0);
    EXPECT_EQ(got[1], 0);
    EXPECT_GT(got[2], 0);
}

TEST(PassersBy, WhatMayGoAnyWayReachesAllAround) {
    test::Room room = corridor();
    FallZone zone;
    zone.from = {3, 1, 0.5};
    zone.highest_m = 1;
    double last = 0;
    for (const double radius : {0.05, 0.3, 0.6}) {
        zone.ahead_m = radius;
        const double share = shares(room, {zone})[0];
        EXPECT_GT(share, last);
        last = share;
    }
    zone.from = {20, 1, 0.5};
    EXPECT_EQ(shares(room, {zone})[0], 0) << "off the map";
}

TEST(PassersBy, NobodyIsKnownWhereNobodyCanWalk) {
    test::Room room(0.025);
    room.box(0, 1, 0, 1, 0, 1);
    EXPECT_TRUE(shares(room, {across(1)}).empty());
    test::Room walked = corridor();
    EXPECT_TRUE(shares(walked, {}).empty());
}

}  // namespace
}  // namespace topple::safety
