// SPDX-License-Identifier: MIT
#include "safety/human/passers_by.h"

#include <gtest/gtest.h>

#include <cmath>

#include "room.h"

namespace topple::safety {
namespace {

// A corridor of 6 x 2 m along x, its floor at 0.
test::Room corridor() {
    test::Room room(0.025);
    room.floor(0, 6, 0, 2);
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
