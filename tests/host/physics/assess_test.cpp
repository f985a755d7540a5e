// SPDX-License-Identifier: MIT
#include "device/devices.h"
#include "host/physics/solids.h"
#include "physics/drop.h"
#include "physics/fall_sweep.h"
#include "testing.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

class Assess : public ::testing::Test {
  protected:
    std::unique_ptr<device::Device> device = device::open_native(2);
};

TEST_F(Assess, OverhangTipsOverTheTable) {
    // A 0.4 m bar, 0.1 m wide and high, on a table that holds the 0.25 m of it with x < 0.05.
    const SolidCells cells = test::voxelise({{0, test::box({-0.2, 0, 0}, {0.2, 0.1, 0.1})}},
                                            {-0.2, 0, 0}, {0.2, 0.1, 0.1}, 0.01);
    Candidate bar = test::standing(*device, cells);
    bar.support_polygon = {{-0.2, 0}, {0.05, 0}, {0.05, 0.1}, {-0.2, 0.1}};
    Candidate out = bar;
    out.support_polygon = {{-0.2, 0}, {-0.03, 0}, {-0.03, 0.1}, {-0.2, 0.1}};
    Candidate none = bar;
    none.support_polygon.clear();
    const Stability s[] = {test::stability(cells, bar), test::stability(cells, out),
                           test::stability(cells, none)};
    const double weight = bar.body.mass_kg * gravity;
    EXPECT_NEAR(s[0].barrier_J, weight * (std::sqrt(0.05 * 0.05 + 0.05 * 0.05) - 0.05),
                1e-6 * weight);
    EXPECT_NEAR(s[0].margin_m, 0.05, 1e-9);
    EXPECT_EQ(s[1].barrier_J, 0);
    EXPECT_NEAR(s[1].margin_m, -0.03, 1e-9);
    EXPECT_NEAR(s[1].easiest.direction[0], 1, 1e-9);
    EXPECT_EQ(s[2].barrier_J, 0);
    EXPECT_LT(s[2].margin_m, 0);
}

TEST_F(Assess, WhatTipsOverTheTableFallsToTheFloor) {
    // A bar as above, but 0.2 m wide, on a table 0.5 m above a floor; on a plane it would land no
    // lower.
    const double table_m = 0.5;
    const test::Solid solid{0, test::box({-0.2, 0, 0}, {0.2, 0.2, 0.1})};
    const SolidCells cells = test::voxelise({solid,
                                             {1, test::box({-0.5, -0.5, -0.05}, {0.05, 0.5, 0})},
                                             {2, test::box({-1, -1, -0.55}, {1, 1, -table_m})}},
                                            {-1, -1, -0.55}, {1, 1, 0.1}, 0.025);
    Candidate bar = test::standing(
        *device, test::voxelise({solid}, {-0.2, 0, 0}, {0.2, 0.2, 0.1}, cells.voxel_m));
    bar.support_polygon = {{-0.2, 0}, {0.05, 0}, {0.05, 0.2}, {-0.2, 0.2}};
    const CellColumns columns(cells);
    bar.edge_drop_m = drops_when_tipped_m(cells, columns, bar);
    // One value for each edge: towards -y, +x, +y and -x. Only +x leads off the table.
    ASSERT_EQ(bar.edge_drop_m.size(), 4u);
    EXPECT_EQ(std::ranges::count(bar.edge_drop_m, 0.0), 3);
    EXPECT_NEAR(bar.edge_drop_m[1], table_m, 1e-9);
    // Where nobody saw the table end it may go on.
    const Unseen beyond = [](std::int32_t i, std::int32_t, std::int32_t k) {
        return i >= 2 && k == -1;
    };
    EXPECT_EQ(drops_when_tipped_m(cells, columns, bar, beyond), std::vector<double>(4, 0.0));
    const Stability s = test::stability(cells, bar);
    const double weight = bar.body.mass_kg * gravity, climb = std::sqrt(2) * 0.05 - 0.05;
    ASSERT_EQ(s.curve.size(), 1u);
    EXPECT_NEAR(s.curve[0].W_J, weight * climb, 1e-6 * weight);
    EXPECT_NEAR(s.curve[0].S_J, weight * (climb + table_m), 1e-6 * weight);
    EXPECT_NEAR(s.release_J, s.curve[0].S_J, 1e-12);
    EXPECT_NEAR(s.easiest.direction[0], 1, 1e-9);
    EXPECT_NEAR(s.easiest.drop_m, table_m, 1e-9);
    ASSERT_TRUE(s.easiest.edge);
    for (const Vec3& end : *s.easiest.edge) {
        EXPECT_NEAR(end[0], 0.05, 1e-9);
        EXPECT_NEAR(end[2], 0, 1e-9);
    }
    EXPECT_NEAR(std::abs((*s.easiest.edge)[0][1] - (*s.easiest.edge)[1][1]), 0.2, 1e-9);
    EXPECT_EQ(met_when_tipped(cells, columns, bar, s.easiest.direction, (*s.easiest.edge)[0]), 2);
    // Half over the edge it falls by itself.
    bar.support_polygon = {{-0.2, 0}, {-0.01, 0}, {-0.01, 0.2}, {-0.2, 0.2}};
    bar.edge_drop_m = drops_when_tipped_m(cells, columns, bar);
    ASSERT_EQ(bar.edge_drop_m.size(), 1u);
    const Stability out = test::stability(cells, bar);
    EXPECT_EQ(out.barrier_J, 0);
    EXPECT_NEAR(out.release_J, weight * bar.edge_drop_m[0], 1e-6 * weight);
    bar.edge_drop_m = {0, 0};
    EXPECT_THROW(test::stability(cells, bar), Error);
}

TEST_F(Assess, WhatHangsBesideTheSupportDoesNotLiftIt) {
    // A box with a strip along one side that hangs 10 cm below the table on which it stands.
    const SolidCells cells = test::voxelise({{0, test::box({0, 0, 0}, {0.2, 0.2, 0.3})},
                                             {0, test::box({0.2, 0, -0.1}, {0.22, 0.2, 0.3})}},
                                            {0, 0, -0.1}, {0.22, 0.2, 0.3}, 0.02);
    Candidate box = test::standing(*device, cells);
    box.support_polygon = {{0, 0}, {0.2, 0}, {0.2, 0.2}, {0, 0.2}};
    box.support_height_m = 0;
    const Stability s = test::stability(cells, box);
    const double weight = box.body.mass_kg * gravity, h = box.body.center[2];
    const double edge = 0.2 - box.body.center[0];  // the nearest
    EXPECT_NEAR(s.barrier_J, weight * (std::hypot(h, edge) - h), 1e-9 * weight);
    EXPECT_NEAR(s.easiest.direction[0], 1, 1e-9);
    EXPECT_GT(s.release_J, 0);
}

TEST_F(Assess, GroupsCombineTheirMembersRows) {
    // A slab on a thin post: on its own the slab is flat and safe, together they tip.
    const SolidCells cells = test::voxelise({{0, test::box({-0.02, -0.02, 0}, {0.02, 0.02, 0.5})},
                                             {1, test::box({-0.2, -0.2, 0.5}, {0.2, 0.2, 0.54})}},
                                            {-0.2, -0.2, 0}, {0.2, 0.2, 0.54}, 0.01);
    const std::vector<double> density{700, 700};
    const std::vector<MassProperties> bodies = mass_properties(*device, cells, 2, density);
    Candidate both;
    both.primitives = {0, 1};
    both.body = combine(bodies);
    both.support_polygon = {{-0.02, -0.02}, {0.02, -0.02}, {0.02, 0.02}, {-0.02, 0.02}};
    const Stability s = test::stability(cells, both);
    const double h = both.body.center[2], weight = both.body.mass_kg * gravity;
    EXPECT_NEAR(s.barrier_J, weight * (std::sqrt(h * h + 0.02 * 0.02) - h), 1e-5 * weight);
    EXPECT_GT(s.release_J, weight * 0.1);  // it comes to lie on the slab's rim
}

TEST_F(Assess, UnevenFeetDoNotRock) {
    // A stool whose one foot is a voxel short, as scans have it, still stands.
    const double voxel = 0.02;
    std::vector<test::Solid> parts{{0, test::box({-0.2, -0.2, 0.4}, {0.2, 0.2, 0.44})}};
    int foot = 0;
    for (const double x : {-0.2, 0.16}) {
        for (const double y : {-0.2, 0.16}) {
            parts.push_back(
                {0, test::box({x, y, foot++ == 0 ? voxel : 0.0}, {x + 0.04, y + 0.04, 0.4})});
        }
    }
    const SolidCells cells = test::voxelise(parts, {-0.2, -0.2, 0}, {0.2, 0.2, 0.44}, voxel);
    Candidate stool = test::standing(*device, cells);
    stool.support_polygon = {{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.2}, {-0.2, 0.2}};
    const Stability s = test::stability(cells, stool);
    const double h = stool.body.center[2], weight = stool.body.mass_kg * gravity;
    const double over_an_edge = weight * (std::sqrt(h * h + 0.2 * 0.2) - h);
    EXPECT_NEAR(s.barrier_J, over_an_edge, 0.25 * over_an_edge);
}

// A dent under a box lets its hull rock; it stood, so that it tips over its edges, as the closed
// form has it.
TEST_F(Assess, WhatStoodTipsOverItsSupport) {
    const double voxel = 0.02;
    const SolidCells cells =
        test::voxelise({{0, test::box({-0.1, -0.1, 0}, {0.1, 0.1, 0.4})},
                        {0, test::box({-0.02, -0.02, -0.08}, {0.02, 0.02, 0})}},
                       {-0.1, -0.1, -0.08}, {0.1, 0.1, 0.4}, voxel);
    Candidate box = test::standing(*device, cells);
    box.support_polygon = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};
    box.support_height_m = 0;
    box.stood = true;
    const Stability s = test::stability(cells, box);
    const double h = box.body.center[2], weight = box.body.mass_kg * gravity;
    EXPECT_NEAR(s.barrier_J, weight * (std::sqrt(h * h + 0.1 * 0.1) - h), 1e-5 * weight);
    // Outside of its support it falls, whatever was seen.
    box.support_polygon = {{0.05, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {0.05, 0.1}};
    EXPECT_EQ(test::stability(cells, box).barrier_J, 0);
}

// A sign on a hook: its centre hangs below what holds it.
TEST_F(Assess, WhatHangsFromAboveItsCentreStays) {
    const SolidCells cells = test::voxelise({{0, test::box({-0.2, -0.02, 0}, {0.2, 0.02, 0.3})}},
                                            {-0.2, -0.02, 0}, {0.2, 0.02, 0.3}, 0.02);
    Candidate sign = test::standing(*device, cells);
    sign.support_polygon = {{-0.1, -0.02}, {0.1, -0.02}, {0.1, 0.02}, {-0.1, 0.02}};
    sign.support_height_m = 0.3;
    sign.stood = true;
    const Stability s = test::stability(cells, sign);
    const double weight = sign.body.mass_kg * gravity;
    EXPECT_NEAR(s.barrier_J, weight * (std::hypot(0.15, 0.02) + 0.15), 1e-5 * weight);
}

TEST_F(Assess, FarFromTheOriginNothingChanges) {
    const SolidCells near = test::voxelise({{0, test::box({0, 0, 0}, {0.3, 0.2, 0.5})}}, {0, 0, 0},
                                           {0.3, 0.2, 0.5}, 0.02);
    SolidCells far = near;
    for (auto& i : far.i) i += 500000;
    for (auto& k : far.k) k -= 300000;
    double barrier[2];
    for (int n = 0; n < 2; ++n) {
        const SolidCells& cells = n ? far : near;
        const Candidate candidate = test::standing(*device, cells);
        barrier[n] = test::stability(cells, candidate).barrier_J;
    }
    EXPECT_NEAR(barrier[0], barrier[1], 1e-5 * barrier[0]);
}

TEST_F(Assess, OneVoxelAndNoVoxels) {
    SolidCells cells;
    cells.voxel_m = 0.02;
    cells.i = cells.j = cells.k = {3};
    cells.primitive = {1};
    cells.basis = {Basis::surface};
    Candidate nothing, cube;
    nothing.primitives = {0, 2};
    cube.primitives = {1, 2};
    const std::vector<double> density(3, 700.0);
    cube.body = mass_properties(*device, cells, 3, density)[1];
    cube.support_polygon = {{0.06, 0.06}, {0.08, 0.06}, {0.08, 0.08}, {0.06, 0.08}};
    cube.support_height_m = 0.06;
    EXPECT_EQ(test::stability(cells, nothing).barrier_J, 0);
    EXPECT_EQ(test::stability(cells, Candidate{}).barrier_J, 0);
    const Stability s = test::stability(cells, cube);
    EXPECT_EQ(s.barrier_J, 0);  // one voxel may as well be a ball
    EXPECT_NEAR(s.margin_m, 0.01, 1e-12);
}

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
