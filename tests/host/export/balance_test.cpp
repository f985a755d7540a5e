// SPDX-License-Identifier: MIT
#include "export/balance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "blocks.h"
#include "export/touching.h"

namespace topple::exports {
namespace {

constexpr double friction = 0.3, gravity = 9.81;

Body standing(ConvexPart part, int level, std::vector<std::int32_t> carried_by = {}) {
    Body out = test::body_of(std::move(part), level, std::move(carried_by));
    out.firm_m = 0.01;
    return out;
}
Body floor() {
    return test::body_of(test::block({-2, -2, -0.1}, {2, 2, 0}), 0, {});
}
// A board on two posts which are things of their own, the second at `post_x`; and a load at its
// end.
std::vector<Body> board_with_load(double post_x, double load_m) {
    std::vector<Body> out{floor()};
    out.push_back(standing(test::block({-0.5, -0.2, 0}, {-0.4, 0.2, 0.7}), 1));
    out.push_back(standing(test::block({post_x - 0.1, -0.2, 0}, {post_x, 0.2, 0.7}), 1));
    out.push_back(standing(test::block({-0.5, -0.2, 0.7}, {0.5, 0.2, 0.72}), 2, {1, 2}));
    out.push_back(standing(test::block({0.4, -0.1, 0.72}, {0.5, 0.1, 0.72 + load_m}), 3, {3}));
    return out;
}

// By body: free, on a pad, held.
std::string kept(std::vector<Body> bodies) {
    const std::size_t count = bodies.size();
    keep_balance(bodies, {friction, gravity});
    std::string out;
    for (std::size_t n = 0; n < count; ++n)
        out += bodies[n].held ? 'h' : bodies[n].on_pad ? 'p' : '.';
    return out;
}

TEST(Balance, WhatStandsIsLeftFree) {
    EXPECT_EQ(kept(board_with_load(0.5, 0.4)), ".....");
    std::vector<Body> stack{floor()};
    for (int n = 0; n < 10; ++n)
        stack.push_back(standing(test::block({0, 0, 0.1 * n}, {0.3, 0.3, 0.1 * (n + 1)}), n + 1));
    EXPECT_EQ(kept(stack), "...........");
}

TEST(Balance, WhatGoesOverWithItsLoadGetsAPadAndTheLoadDoesNot) {
    // Torques about the inner post's edge at x = 0.1: board 5.6 kg at 0, load 7 kg a litre at 0.45.
    const double balance_m = 5.6 * 0.1 / (0.35 * 14);  // height of the load that tips it: 0.114 m
    EXPECT_EQ(kept(board_with_load(0.1, 0.9 * balance_m)), ".....");
    EXPECT_EQ(kept(board_with_load(0.1, 1.1 * balance_m)), "...p.");
}

TEST(Balance, WhatFallsByItselfMayDoSo) {
    std::vector<Body> bodies = board_with_load(0.1, 0.4);
    bodies[3].firm_m = 0;
    // The load stands on it and goes down with it: only what is said to stand is held.
    EXPECT_EQ(kept(bodies), "....h");
}

// Four fifths of it, to be sure.
TEST(Balance, FrictionHoldsOnASlopeUpToItsAngle) {
    for (const double slope : {0.23, 0.27}) {
        // A wedge, fixed, and a slab on it.
        const double z = 2 * slope;
        std::vector<Body> bodies{
            test::body_of(*hull_part(std::vector<Vec3>{
                              {0, 0, 0}, {2, 0, 0}, {2, 0, z}, {0, 1, 0}, {2, 1, 0}, {2, 1, z}}),
                          0, {})};
        const double c = 1 / std::hypot(1, slope), s = slope * c;
        std::vector<Vec3> corners;
        for (unsigned n = 0; n < 8; ++n) {
            const double u = (n & 1) != 0 ? 1.2 : 0.9, w = (n & 4) != 0 ? 0.05 : 0;
            corners.push_back({u * c - w * s, (n & 2) != 0 ? 0.6 : 0.3, u * s + w * c});
        }
        bodies.push_back(standing(*hull_part(corners), 1));
        bodies[1].center_m = {1.05 * c - 0.025 * s, 0.45, 1.05 * s + 0.025 * c};
        EXPECT_EQ(kept(bodies), slope > 0.8 * friction ? ".h" : "..") << slope;
    }
}

TEST(Balance, WhatNothingCarriesGetsAPadOrIsHeld) {
    std::vector<Body> bodies{floor(), standing(test::block({0, 0, 0.2}, {0.3, 0.3, 0.5}), 1)};
    EXPECT_EQ(kept(bodies), ".p") << "in the air";
    // Its centre of mass lies beyond all of it.
    bodies[1].center_m[0] = 1;
    EXPECT_EQ(kept(bodies), ".h");
}

TEST(Touching, FacesEdgesAndCornersShareWhatLiesInBoth) {
    const ConvexPart low = test::block({0, 0, 0}, {1, 1, 1});
    const auto touch = touch_of(low, test::block({0.5, 0.25, 1}, {1.5, 0.75, 2}));
    EXPECT_NEAR(touch.normal[2], 1, 1e-9);
    ASSERT_EQ(touch.point.size(), 4u);
    double most = 0, least = 2;
    for (const Vec3& p : touch.point) {
        EXPECT_NEAR(p[2], 1, 1e-9);
        most = std::max(most, p[0]);
        least = std::min(least, p[0]);
    }
    EXPECT_NEAR(least, 0.5, 1e-9);
    EXPECT_NEAR(most, 1, 1e-9);
    const auto side = touch_of(low, test::block({1, 0.2, 0.2}, {2, 0.4, 0.4}));
    EXPECT_NEAR(side.normal[0], 1, 1e-9);
    EXPECT_EQ(side.point.size(), 4u);
    EXPECT_TRUE(touch_of(low, test::block({0, 0, 1.001}, {1, 1, 2})).point.empty());
    // A roof upside down stands on its ridge.
    const auto ridge = touch_of(
        low,
        *hull_part(std::vector<Vec3>{
            {0.2, 0.5, 1}, {0.8, 0.5, 1}, {0.2, 0, 2}, {0.8, 0, 2}, {0.2, 1, 2}, {0.8, 1, 2}}));
    EXPECT_GE(ridge.point.size(), 2u);
}

}  // namespace
}  // namespace topple::exports
