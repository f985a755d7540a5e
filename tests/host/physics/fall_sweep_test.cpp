// SPDX-License-Identifier: MIT
#include "physics/fall_sweep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/physics/solids.h"

namespace topple::physics {
namespace {

using test::box;
using test::Solid;

// A bookcase, label 0, 0.3 m deep and 2 m high, that falls along +x; its edge is at x = 0.3.
constexpr double grid_m = 0.02, edge_m = 0.3, inside_m = 0.15, middle_m = 1, summit_m = 2;

Swept falling(const std::vector<Solid>& others, const HiddenWalls& walls = {},
              const std::vector<bool>& stops = {}, std::span<const std::int32_t> along = {}) {
    std::vector<Solid> all{{0, box({0, 0, 0}, {edge_m, 0.6, summit_m})},
                           {1, box({-1, -1, -0.1}, {4, 2, 0})}};
    all.insert(all.end(), others.begin(), others.end());
    const SolidCells cells = test::voxelise(all, {-1, -1, -0.1}, {4, 2, 2.6}, grid_m);
    Candidate body;
    body.primitives = {0};
    body.body.center = {edge_m - inside_m, 0.3, middle_m};
    return sweep_over_edge(cells, CellColumns(cells), walls, body, along, 0, {1, 0, 0}, inside_m,
                           summit_m, stops);
}

TEST(FallSweep, WithRoomItLiesOnItsSide) {
    const Swept swept = falling({});
    EXPECT_FALSE(swept.stopped);
    EXPECT_EQ(swept.by, -1);
    EXPECT_NEAR(swept.center[0], edge_m + middle_m, 1e-9);
    EXPECT_NEAR(swept.center[1], 0.3, 1e-9);
    EXPECT_NEAR(swept.center[2], inside_m, 1e-9);
}

TEST(FallSweep, AWallStopsItsTop) {
    for (const double wall : {0.5, 1.0, 1.8}) {
        const Swept swept = falling({{2, box({wall, -1, 0}, {wall + 0.1, 2, 2.5})}});
        ASSERT_TRUE(swept.stopped) << wall;
        EXPECT_EQ(swept.by, 2);
        const double angle = std::asin((wall - edge_m) / summit_m);
        EXPECT_NEAR(swept.center[0],
                    edge_m - inside_m * std::cos(angle) + middle_m * std::sin(angle), 2 * grid_m);
        EXPECT_NEAR(swept.center[2], middle_m * std::cos(angle) + inside_m * std::sin(angle),
                    2 * grid_m);
        EXPECT_LT(swept.center[0], wall);
    }
}

TEST(FallSweep, WhatGoesWithItIsNoStop) {
    const std::int32_t along[] = {2};
    const std::vector<Solid> hat{{2, box({0.2, 0, 1.9}, {0.7, 0.6, 2.2})}};
    EXPECT_TRUE(falling(hat).stopped);
    EXPECT_FALSE(falling(hat, {}, {}, along).stopped);
}

TEST(FallSweep, ATableHoldsItUp) {
    const Swept swept = falling({{2, box({1.5, 0, 0}, {2.2, 0.6, 0.7})}});
    ASSERT_TRUE(swept.stopped);
    EXPECT_EQ(swept.by, 2);
    // Over the corner of the table, at 1.2 m ahead and 0.7 m up.
    const double angle = std::atan2(1.2, 0.7);
    EXPECT_NEAR(swept.center[2], middle_m * std::cos(angle) + inside_m * std::sin(angle),
                3 * grid_m);
}

TEST(FallSweep, BehindAWallItStaysWhereItIs) {
    const Swept swept = falling({{2, box({edge_m, -1, 0}, {edge_m + 2 * grid_m, 2, 2.5})}});
    ASSERT_TRUE(swept.stopped);
    EXPECT_NEAR(swept.center[0], edge_m - inside_m, 2 * grid_m);
    EXPECT_NEAR(swept.center[2], middle_m, 2 * grid_m);
}

TEST(FallSweep, AWallThatNobodySawStopsIt) {
    const HiddenWalls walls({{7, {1, 0}, {0, 1}, 0.5, -1, 3, 0, {2.5f}}});
    const Swept swept = falling({}, walls), seen = falling({{2, box({0.5, -1, 0}, {0.6, 2, 2.5})}});
    ASSERT_TRUE(swept.stopped);
    EXPECT_EQ(swept.by, 7);
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(swept.center[a], seen.center[a], 2 * grid_m);
    EXPECT_FALSE(falling({}, HiddenWalls({{7, {1, 0}, {0, 1}, 0.5, 1, 3, 0, {2.5f}}})).stopped);
}

// What gives way leaves it to what does not.
TEST(FallSweep, OnlyWhatIsToStopItDoes) {
    const std::vector<Solid> others{{2, box({0.5, -1, 0}, {0.6, 2, 2.5})},
                                    {3, box({1, -1, 0}, {1.1, 2, 2.5})}};
    EXPECT_EQ(falling(others).by, 2);
    EXPECT_EQ(falling(others, {}, {false, true, false, true}).by, 3);
    EXPECT_FALSE(falling(others, {}, {false, true, false, false}).stopped);
}

TEST(FallSweep, CrumbsAndWhatIsOutOfReachAreNoStop) {
    EXPECT_FALSE(falling({{2, box({0.8, 0.29, 1.5}, {0.82, 0.32, 1.52})}}).stopped);
    EXPECT_FALSE(falling({{2, box({2.6, -1, 0}, {2.7, 2, 2.5})}}).stopped);
}

}  // namespace
}  // namespace topple::physics
