// SPDX-License-Identifier: MIT
#include "export/stand.h"

#include <gtest/gtest.h>

#include <cmath>

#include "export/separate.h"
#include "host/export/blocks.h"

namespace topple::exports::test {
namespace {

Body ground() {
    return body_of(block({-2, -2, -0.1}, {2, 2, 0}), 0, {});
}

TEST(Separate, WhatStandsGivesWayToWhatCarriesIt) {
    std::vector<Body> bodies{ground(), body_of(block({0, 0, -0.004}, {0.2, 0.2, 0.5}), 1, {0})};
    EXPECT_GT(deepest_overlap_m(bodies), 0.0039);
    separate(bodies);
    EXPECT_LT(deepest_overlap_m(bodies), 1e-6);
    EXPECT_NEAR(bodies[0].parts[0].high[2], 0, 1e-9);
    EXPECT_NEAR(bodies[1].parts[0].low[2], 0, 1e-9);
    EXPECT_NEAR(bodies[1].lost_m3, 0.2 * 0.2 * 0.004, 1e-9);
}

TEST(Separate, AHullThatIsHollowGivesWayToASolid) {
    // A slab with a bump at its far end: its hull rises above it where something stands.
    Body slab = body_of(block({0, 0, -0.1}, {1, 1, 0}), 0, {});
    std::vector<Vec3> points = slab.parts[0].corner;
    points.push_back({1, 0, 0.1});
    points.push_back({1, 1, 0.1});
    ConvexPart hull = *hull_part(points);
    hull.solid = slab.parts[0].solid;
    hull.solid_each_m3 = slab.parts[0].solid_each_m3;
    slab.parts[0] = hull;
    std::vector<Body> bodies{slab, body_of(block({0.2, 0.2, 0}, {0.5, 0.5, 0.4}), 1, {0})};
    separate(bodies);
    EXPECT_LT(deepest_overlap_m(bodies), 1e-6);
    EXPECT_NEAR(bodies[1].parts[0].low[2], 0, 2 * on_plane_m);
}

TEST(Separate, WhatOnlyEdgesTellApartIsLeftAsItIs) {
    // Two square rods, each on an edge, crossing: neither's faces tell them apart.
    std::vector<Vec3> low, high;
    for (const double end : {-1.0, 1.0}) {
        for (const double side : {-0.1, 0.1}) {
            low.push_back({end, side, 0});
            low.push_back({end, 0, side});
            high.push_back({side, end, 0.205});
            high.push_back({0, end, 0.205 + side});
        }
    }
    const ConvexPart a = *hull_part(low), b = *hull_part(high);
    EXPECT_LT(apart(a, b).gap_m, 0);
    EXPECT_FALSE(overlap(a, b));
    std::vector<Body> bodies{body_of(a, 1, {}), body_of(b, 2, {0})};
    separate(bodies);
    EXPECT_EQ(bodies[0].lost_m3, 0);
    EXPECT_EQ(bodies[1].lost_m3, 0);
}

TEST(Settle, ClosesAGapThatNoiseLeft) {
    std::vector<Body> bodies{ground(), body_of(block({0, 0, 0.006}, {0.2, 0.2, 0.5}), 1, {0})};
    settle(bodies, 0.01);
    ASSERT_EQ(bodies.size(), 2u);
    EXPECT_NEAR(bodies[1].parts[0].low[2], 0, 1e-9);
    EXPECT_NEAR(bodies[1].moved_m[2], -0.006, 1e-9);
    EXPECT_NEAR(bodies[1].center_m[2], 0.253 - 0.006, 1e-9);
}

TEST(Settle, WhatNothingCarriesGetsAPad) {
    std::vector<Body> bodies{ground(), body_of(block({0, 0, 1}, {0.2, 0.2, 1.5}), 1, {})};
    settle(bodies, 0.01);
    ASSERT_EQ(bodies.size(), 3u);
    EXPECT_TRUE(bodies[1].on_pad);
    EXPECT_TRUE(bodies[2].fixed);
    EXPECT_NEAR(bodies[2].parts[0].high[2], 1, 1e-9);
    EXPECT_EQ(bodies[1].carried_by, std::vector<std::int32_t>{2});
}

TEST(Settle, WhatWouldFallOffItsPadIsHeld) {
    Body hook = body_of(block({0, 0, 1}, {0.02, 0.02, 1.2}), 1, {});
    hook.parts.push_back(block({0.02, 0, 1.1}, {0.5, 0.02, 1.2}));
    hook.center_m = {0.3, 0.01, 1.15};
    std::vector<Body> bodies{ground(), hook};
    settle(bodies, 0.01);
    ASSERT_EQ(bodies.size(), 2u);
    EXPECT_TRUE(bodies[1].held);
    EXPECT_TRUE(bodies[1].fixed);
}

TEST(FlattenFeet, ATiltedFootBecomesFlat) {
    std::vector<Vec3> points = block({0, 0, 0}, {0.2, 0.2, 0.5}).corner;
    for (Vec3& p : points)
        if (p[2] == 0 && p[0] > 0.1) p[2] = 0.004;
    std::vector<Body> bodies{ground(), body_of(*hull_part(points), 1, {0})};
    flatten_feet(bodies, 0.01);
    std::size_t down = 0;
    for (const Vec3& c : bodies[1].parts[0].corner) down += std::abs(c[2]) < 1e-9;
    EXPECT_EQ(down, 4u);
}

}  // namespace
}  // namespace topple::exports::test
