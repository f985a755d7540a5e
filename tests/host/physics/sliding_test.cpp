// SPDX-License-Identifier: MIT
#include "physics/sliding.h"

#include "device/devices.h"
#include "host/physics/solids.h"
#include "testing.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

using test::box;

class Sliding : public ::testing::Test {
  protected:
    std::unique_ptr<device::Device> device = device::open_native(2);
    // Each label is an object.
    std::vector<SlideResult> slide(const std::vector<test::Solid>& solids, const Vec3& low,
                                   const Vec3& high, double voxel, std::int32_t objects,
                                   bool places = false) {
        const SolidCells cells = test::voxelise(solids, low, high, voxel);
        const auto n = static_cast<std::size_t>(objects);
        const std::vector<double> density(n, 700), friction(n, 0.3);
        std::vector<std::int32_t> own(n);
        for (std::size_t p = 0; p < n; ++p) own[p] = static_cast<std::int32_t>(p);
        return slide_all(cells, own, mass_properties(*device, cells, objects, density), friction,
                         {.places = places});
    }
    // Floor; a table 1.2 x 0.8 x 0.75 over [0, 1.2] x [0, 0.8]; a 0.1 m cube 0.2 m from the table's
    // low-x edge.
    std::vector<test::Solid> room{{0, box({-2, -2, -0.1}, {3, 3, 0})},
                                  {1, box({0, 0, 0.7}, {1.2, 0.8, 0.75})},
                                  {1, box({0.5, 0.3, 0}, {0.7, 0.5, 0.7})},
                                  {2, box({0.15, 0.35, 0.75}, {0.25, 0.45, 0.85})}};
};

// From another place on the table the way and the drop are those of a cube that stands there.
TEST_F(Sliding, FromAnotherPlaceItIsAsIfItStoodThere) {
    const double voxel = 0.025;
    const SolidCells cells = test::voxelise(room, {-2, -2, -0.1}, {3, 3, 1}, voxel);
    const std::vector<double> density(3, 700);
    const std::vector<std::int32_t> own{0, 1, 2};
    const auto bodies = mass_properties(*device, cells, 3, density);
    const std::size_t cube = 2;
    const auto places =
        places_of(cells, own, bodies, std::span(&cube, 1), std::vector(3, 0.3), 1.3).at(0);
    ASSERT_GT(places.side, 20);
    EXPECT_NEAR(places.step_m * (places.side / 2), 1.3, 0.051);
    const std::int32_t half = places.side / 2;
    int compared = 0;
    for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {0.2, 0.0}, {0.4, 0.1}, {0.8, -0.1}}) {
        const auto a = half + static_cast<std::int32_t>(std::lround(dx / places.step_m));
        const auto b = half + static_cast<std::int32_t>(std::lround(dy / places.step_m));
        const SlideElsewhere there = slide_elsewhere(places, a, b, bodies[cube].mass_kg, 0.3);
        ASSERT_TRUE(there.reachable) << dx;
        std::vector<test::Solid> moved = room;
        moved.back() = {2, box({0.15 + dx, 0.35 + dy, 0.75}, {0.25 + dx, 0.45 + dy, 0.85})};
        const SlideResult s = slide(moved, {-2, -2, -0.1}, {3, 3, 1}, voxel, 3)[2];
        ASSERT_EQ(there.slide.found, s.found);
        EXPECT_NEAR(there.slide.distance_m, s.distance_m, places.step_m) << dx;
        EXPECT_NEAR(there.slide.released_J, s.released_J, 1e-5) << dx;
        ++compared;
    }
    EXPECT_EQ(compared, 4);
    EXPECT_FALSE(slide_elsewhere(places, half - 12, half, 0.7, 0.3).reachable) << "beyond the edge";
}

// It stands on the floor, and most of its columns reach over a shelf: that is not what it slides
// off.
TEST_F(Sliding, WhatReachesOverAShelfSlidesWhereItStands) {
    const SolidCells cells = test::voxelise({{0, box({-2, -2, -0.1}, {2, 2, 0})},
                                             {1, box({0.15, -0.2, 0}, {0.8, 0.4, 0.9})},
                                             {2, box({0, 0, 0}, {0.1, 0.2, 0.9})},
                                             {2, box({0, 0, 0.9}, {0.6, 0.2, 1})}},
                                            {-2, -2, -0.1}, {2, 2, 1.1}, 0.025);
    const std::vector<double> density(3, 700), friction(3, 0.3);
    const std::vector<std::int32_t> own{0, 1, 2};
    const auto bodies = mass_properties(*device, cells, 3, density);
    std::vector<KnownFooting> stances(3);
    EXPECT_TRUE(slide_all(cells, own, bodies, friction, {.stances = stances})[2].found);
    stances[2] = {{{0, 0}, {0.6, 0}, {0.6, 0.2}, {0, 0.2}}, 0, false};
    EXPECT_FALSE(slide_all(cells, own, bodies, friction, {.stances = stances})[2].found);
}

// Nobody saw the table's low-x edge: it may go on there, and the cube falls off another edge. A
// strip beside an edge is what grazing rays leave.
TEST_F(Sliding, WhatNobodySawMayCarry) {
    const double voxel = 0.025;
    const SolidCells cells = test::voxelise(room, {-2, -2, -0.1}, {3, 3, 1}, voxel);
    const std::vector<double> density(3, 700), friction(3, 0.3);
    const std::vector<std::int32_t> own{0, 1, 2};
    const auto bodies = mass_properties(*device, cells, 3, density);
    const auto distance_m = [&](std::int32_t wide) {
        const Unseen unseen = [&](std::int32_t i, std::int32_t, std::int32_t k) {
            return k == 29 && i < 0 && i >= -wide;
        };
        const SlideResult s = slide_all(cells, own, bodies, friction, {.unseen = unseen})[2];
        EXPECT_TRUE(s.found);
        return s.distance_m;
    };
    EXPECT_NEAR(distance_m(0), 0.2, 1e-9);
    EXPECT_NEAR(distance_m(noise_gap - 1), 0.2, 1e-9);
    EXPECT_NEAR(distance_m(noise_gap), 0.4, 1e-9);
    EXPECT_NEAR(distance_m(40), 0.4, 1e-9);
    const Unseen all = [](std::int32_t, std::int32_t, std::int32_t) { return true; };
    EXPECT_FALSE(slide_all(cells, own, bodies, friction, {.unseen = all})[2].found);
}

TEST_F(Sliding, CubeOnATable) {
    for (const double voxel : {0.05, 0.025, 0.0125}) {
        SCOPED_TRACE(voxel);
        const SlideResult s = slide(room, {-2, -2, -0.1}, {3, 3, 1}, voxel, 3)[2];
        ASSERT_TRUE(s.found);
        // The closed form: 0.3 * 0.7 kg * g * 0.2 m, and 0.7 kg * g * 0.75 m.
        EXPECT_NEAR(s.absorbed_J, 0.41188, 0.00001);
        EXPECT_NEAR(s.released_J, 5.14849, 0.00001);
        EXPECT_NEAR(s.distance_m, 0.2, 1e-9);
        EXPECT_NEAR(s.direction[0], -1, 1e-6);
        // Off the low-x edge, at the table's height, around y = 0.4, onto the floor.
        for (const Vec3& end : s.edge) {
            EXPECT_NEAR(end[0], 0, 1e-9);
            EXPECT_NEAR(end[2], 0.75, 1e-9);
        }
        EXPECT_NEAR(0.5 * (s.edge[0][1] + s.edge[1][1]), 0.4, voxel);
        EXPECT_GT(std::abs(s.edge[0][1] - s.edge[1][1]), 0.1);
        EXPECT_EQ(s.onto, 0);
    }
}

// A hole under its centre, wider than its foot: by the columns it falls where it is. What is known
// of how it stood holds it there.
TEST_F(Sliding, WhatStoodDoesNotFallWhereItIs) {
    const double voxel = 0.025;
    const std::vector<test::Solid> bridge{{0, box({-2, -2, -0.1}, {3, 3, 0})},
                                          {1, box({0, 0, 0}, {0.1, 0.4, 0.5})},
                                          {2, box({0, 0.1, 0.5}, {0.4, 0.3, 0.6})}};
    const SolidCells cells = test::voxelise(bridge, {-2, -2, -0.1}, {3, 3, 1}, voxel);
    const std::vector<double> density(3, 700), friction(3, 0.3);
    const std::vector<std::int32_t> own{0, 1, 2};
    const auto bodies = mass_properties(*device, cells, 3, density);
    const SlideResult fell = slide_all(cells, own, bodies, friction)[2];
    ASSERT_TRUE(fell.found);
    EXPECT_EQ(fell.distance_m, 0);
    std::vector<KnownFooting> stances(3);
    stances[2] = {{{0, 0.1}, {0.3, 0.1}, {0.3, 0.3}, {0, 0.3}}, 0.5, true};
    const SlideResult stood = slide_all(cells, own, bodies, friction, {.stances = stances})[2];
    ASSERT_TRUE(stood.found);
    EXPECT_NEAR(stood.distance_m, 0.1, 1e-9) << "from its centre to the border of its support";
    stances.pop_back();
    EXPECT_THROW(slide_all(cells, own, bodies, friction, {.stances = stances}), Error);
}

TEST_F(Sliding, PlacesAroundAreWorkOrFalls) {
    const double voxel = 0.025, weight = 0.7 * gravity;
    // A post in the way, 5 cm wide, beside the cube.
    room.push_back({1, box({0.3, 0.375, 0.75}, {0.35, 0.425, 0.9})});
    const auto all = slide(room, {-2, -2, -0.1}, {3, 3, 1}, voxel, 3, true);
    const Landscape::Places& places = all[2].places;
    EXPECT_EQ(places.step_m, voxel);
    ASSERT_EQ(places.side % 2, 1);
    const std::int32_t half = places.side / 2;
    ASSERT_EQ(places.energy_J.size(), static_cast<std::size_t>(places.side * places.side));
    const auto at = [&](double x, double y) {
        const auto column = half + static_cast<std::int32_t>(std::lround(x / voxel));
        const auto row = half + static_cast<std::int32_t>(std::lround(y / voxel));
        return places.energy_J[row * places.side + column];
    };
    EXPECT_EQ(at(0, 0), 0);
    // Places are columns, and the centre stands on the border of two.
    EXPECT_NEAR(at(-0.1, 0), 0.3 * weight * 0.1, 0.3 * weight * voxel);
    EXPECT_NEAR(at(0, 0.2), 0.3 * weight * 0.2, 0.3 * weight * voxel);
    EXPECT_NEAR(at(-0.25, 0), -weight * 0.75, 1e-3);
    EXPECT_TRUE(std::isinf(at(0.075, 0))) << "the post is in the way";
    EXPECT_TRUE(slide(room, {-2, -2, -0.1}, {3, 3, 1}, 0.05, 3)[2].places.energy_J.empty());
}

TEST_F(Sliding, FloorsHaveNoEdge) {
    const auto s = slide(room, {-2, -2, -0.1}, {3, 3, 1}, 0.05, 3);
    EXPECT_FALSE(s[0].found);  // nothing holds the floor
    EXPECT_FALSE(s[1].found);  // where the floor ends nothing is known
}

TEST_F(Sliding, RimsBlockAndAWayAroundIsFound) {
    // A rim 0.1 m high along the near edge: the next is the low-y edge, 0.4 m away.
    auto with_rim = room;
    with_rim.push_back({1, box({0, 0, 0.75}, {0.05, 0.8, 0.85})});
    const SlideResult around = slide(with_rim, {-2, -2, -0.1}, {3, 3, 1}, 0.025, 3)[2];
    ASSERT_TRUE(around.found);
    EXPECT_NEAR(around.distance_m, 0.4, 1e-9);
    // A wall beside the cube leaves a detour only: up past its end at y = 0.5, then to x = 0. The
    // cube's outline clears the corner (0.1, 0.5) with its centre at (0.15, 0.55), then (0, 0.55).
    auto with_wall = room;
    with_wall.push_back({1, box({0.05, 0, 0.75}, {0.1, 0.5, 0.95})});
    with_wall.push_back({1, box({0.1, 0, 0.75}, {1.2, 0.3, 0.95})});
    const SlideResult detour = slide(with_wall, {-2, -2, -0.1}, {3, 3, 1}, 0.025, 3)[2];
    ASSERT_TRUE(detour.found);
    const double shortest = std::hypot(0.2 - 0.15, 0.55 - 0.4) + 0.15;
    EXPECT_GT(detour.distance_m, 0.3);
    EXPECT_NEAR(detour.distance_m, shortest, 0.05);
    // Walled in all round: no way.
    auto pit = room;
    pit.push_back({1, box({0, 0, 0.75}, {1.2, 0.025, 0.95})});
    pit.push_back({1, box({0, 0.775, 0.75}, {1.2, 0.8, 0.95})});
    pit.push_back({1, box({0, 0, 0.75}, {0.025, 0.8, 0.95})});
    pit.push_back({1, box({1.175, 0, 0.75}, {1.2, 0.8, 0.95})});
    EXPECT_FALSE(slide(pit, {-2, -2, -0.1}, {3, 3, 1}, 0.025, 3)[2].found);
}

// A bowl hides the middle of the plate that it stands on, and is taken to reach down to the table.
TEST_F(Sliding, WhatStandsInItsMiddleMovesAlong) {
    auto laid = room;
    laid.back() = {2, [](double x, double y, double z) {
                       return box({0.1, 0.3, 0.75}, {0.3, 0.5, 0.85})(x, y, z) &&
                              !box({0.15, 0.35, 0.7}, {0.25, 0.45, 0.9})(x, y, z);
                   }};
    const SlideResult empty = slide(laid, {-2, -2, -0.1}, {3, 3, 1}, 0.025, 3)[2];
    laid.push_back({3, box({0.15, 0.35, 0.75}, {0.25, 0.45, 0.9})});
    const SlideResult laden = slide(laid, {-2, -2, -0.1}, {3, 3, 1}, 0.025, 4)[2];
    ASSERT_TRUE(empty.found);
    ASSERT_TRUE(laden.found);
    EXPECT_NEAR(laden.distance_m, empty.distance_m, 1e-9);
    // What it goes around on three sides stays where it is.
    auto fork = room;
    fork.back() = {2, [](double x, double y, double z) {
                       return box({0.1, 0.3, 0.75}, {0.3, 0.5, 0.85})(x, y, z) &&
                              !box({0, 0.35, 0.7}, {0.25, 0.45, 0.9})(x, y, z);
                   }};
    fork.push_back({3, box({0.15, 0.375, 0.75}, {0.2, 0.425, 0.9})});
    const SlideResult held = slide(fork, {-2, -2, -0.1}, {3, 3, 1}, 0.025, 4)[2];
    EXPECT_TRUE(!held.found || held.distance_m > empty.distance_m + 0.05);
}

TEST_F(Sliding, HolesNarrowerThanTheFootAreNoEdge) {
    const auto drilled = [this](const Vec3& low, const Vec3& high) {
        auto solids = room;
        const test::Inside hole = box(low, high), top = box({0, 0, 0.7}, {1.2, 0.8, 0.75});
        solids[1] = {1,
                     [=](double x, double y, double z) { return top(x, y, z) && !hole(x, y, z); }};
        return slide(solids, {-2, -2, -0.1}, {3, 3, 1}, 0.025, 3)[2];
    };
    EXPECT_NEAR(drilled({0.3, 0.375, 0.7}, {0.35, 0.425, 0.75}).distance_m, 0.2, 1e-9);
    // One that it can drop into: the centre leaves the table 0.1 m away.
    EXPECT_NEAR(drilled({0.3, 0.2, 0.7}, {0.6, 0.6, 0.75}).distance_m, 0.1, 1e-9);
}

TEST_F(Sliding, CurvesCombine) {
    Stability tip;
    tip.barrier_J = 2;
    tip.release_J = 5;
    tip.easiest.direction = {1, 0, 0};
    tip.curve = {{2, 5}, {4, 6}};
    SlideResult way;
    way.found = true;
    way.absorbed_J = 1;
    way.released_J = 5.5;
    way.direction = {0, 1, 0};
    Instability both = combine_curves(tip, way);
    EXPECT_EQ(both.mode, Instability::Mode::slide);
    EXPECT_EQ(both.barrier_J, 1);
    EXPECT_EQ(both.release_J, 5.5);
    ASSERT_EQ(both.curve.size(), 2u);
    EXPECT_EQ(both.curve[0].W_J, 1);
    EXPECT_EQ(both.curve[1].W_J, 4);
    way.absorbed_J = 3;
    both = combine_curves(tip, way);
    EXPECT_EQ(both.mode, Instability::Mode::tip);
    EXPECT_EQ(both.curve.size(), 3u);
    // Tipping alone may lead nowhere lower: it is how the body leaves its pose first, all the same.
    tip.release_J = 0;
    tip.curve.clear();
    both = combine_curves(tip, way);
    EXPECT_EQ(both.mode, Instability::Mode::tip);
    EXPECT_EQ(both.barrier_J, 2);
    EXPECT_EQ(both.release_J, 0);
    ASSERT_EQ(both.curve.size(), 1u);
    EXPECT_EQ(both.curve[0].W_J, 3);
    const Instability none = combine_curves(Stability{}, SlideResult{});
    EXPECT_EQ(none.mode, Instability::Mode::none);
    EXPECT_TRUE(none.curve.empty());
}

TEST_F(Sliding, RefusesWhatDoesNotFit) {
    SolidCells cells;
    cells.voxel_m = 0.02;
    EXPECT_TRUE(slide_all(cells, {}, {}, {}).empty());
    cells.i = cells.j = cells.k = {0};
    cells.primitive = {0};
    const std::vector<double> friction{0.3};
    const std::vector<MassProperties> bodies(1);
    EXPECT_THROW(slide_all(cells, {}, bodies, friction), Error);
    EXPECT_THROW(slide_all(cells, {}, bodies, {}), Error);
}

}  // namespace
}  // namespace topple::physics
