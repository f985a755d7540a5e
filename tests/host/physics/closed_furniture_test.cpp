// SPDX-License-Identifier: MIT
#include "physics/closed_furniture.h"

#include "device/devices.h"
#include "host/physics/solids.h"
#include "physics/hollow_body.h"
#include "physics/repeated_objects.h"
#include "testing.h"

namespace topple::physics {
namespace {

constexpr double cell_m = 0.02;

// A wall behind y = 0 and a box of 0.8 x 0.4 x 1.2 m that stands `away` in front of it.
struct BesideWall {
    double away = 0;  // from the wall
    bool half = false;
    double yaw = 0;
    FurnitureLooks looks() const {
        const double c = std::cos(yaw), s = std::sin(yaw);
        const auto turned = [=](const test::Inside& inside) {
            return [=](double x, double y, double z) {
                return inside(c * x + s * y, c * y - s * x, z);
            };
        };
        const test::Inside thing = [this](double x, double y, double z) {
            return std::abs(x) < 0.4 && y > away && y < away + 0.4 && z > 0 && z < 1.2 &&
                   (!half || z < 0.6 || x < 0);
        };
        const SolidScene scene(
            test::voxelise({{0, turned(test::box({-1, -0.1, 0}, {1, 0, 2}))}, {1, turned(thing)}},
                           {-1.5, -1.5, 0}, {1.5, 1.5, 2}, cell_m),
            {Role::wall, Role::none});
        return furniture_looks(scene, std::vector<std::int32_t>{0, 1},
                               std::vector<double>{1, half ? 0.75 * 0.384 : 0.384})[1];
    }
};

TEST(ClosedFurniture, LooksAreThoseOfItsBox) {
    const FurnitureLooks looks = BesideWall{0.04}.looks();
    EXPECT_NEAR(looks.height_m, 1.2, 1e-9);
    EXPECT_NEAR(looks.fill, 1, 1e-9);
    EXPECT_NEAR(looks.backing, 1, 1e-9);
    EXPECT_NEAR(looks.box_side_m2, 2 * (0.8 * 0.4 + 0.8 * 1.2 + 0.4 * 1.2), 1e-9);
    EXPECT_NEAR((BesideWall{0.04, true}.looks().fill), 0.75, 1e-9);
    EXPECT_NEAR(looks.front[0], 0, 1e-9);
    EXPECT_NEAR(looks.front[1], 1, 1e-9) << "away from the wall";
    EXPECT_NEAR(looks.deep_m, 0.4, 1e-9);
}

TEST(ClosedFurniture, DrawersHoldItsContentsAndComeOutOfItsFront) {
    const FurnitureLooks looks = BesideWall{0.04}.looks();
    const ClosedBody body = closed_body(looks, 0.384, 700, 68);
    // Boards of 18 mm around 0.764 x 0.364 x 1.164 m, but for what sides share.
    const double inner = 0.384 - looks.box_side_m2 * 0.018;
    const double share = 68 * inner / (68 * inner + 700 * (0.384 - inner));
    EXPECT_NEAR(body.contents_share, share, 1e-9);
    const Drawers drawers = drawers_of(looks, 0.8, body);
    EXPECT_NEAR(drawers.probability, 0.4, 1e-12);
    EXPECT_NEAR(drawers.out_m, 0.4 * 2 / 3, 1e-9);
    EXPECT_EQ(drawers.way, looks.front);
    EXPECT_EQ(drawers.mass_share, body.contents_share);
}

// Turned as walls of rooms without right angles are.
TEST(ClosedFurniture, LooksAreTheSameAskewToTheGrid) {
    const FurnitureLooks looks = BesideWall{0.03, false, 0.4}.looks();
    EXPECT_NEAR(looks.height_m, 1.2, 1e-9);
    EXPECT_NEAR(looks.fill, 1, 0.12) << "voxels make the box wider";
    EXPECT_GT(looks.backing, 0.9);
    EXPECT_EQ((BesideWall{0.2, false, 0.4}.looks().backing), 0);
}

TEST(ClosedFurniture, WhatStandsFreeHasNothingBehindIt) {
    EXPECT_NEAR(BesideWall{0.06}.looks().backing, 1, 1e-9) << "within 8 cm";
    EXPECT_EQ(BesideWall{0.1}.looks().backing, 0);
    const auto range = [](double away) { return BesideWall{away}.looks().backing_range; };
    EXPECT_NEAR(range(0.08)[1], 1, 1e-9) << "within a voxel more";
    EXPECT_EQ(range(0.12)[1], 0);
    EXPECT_EQ(range(0.06)[0], 0) << "not within a voxel less";
    EXPECT_NEAR(range(0.04)[0], 1, 1e-9);
}

TEST(ClosedFurniture, ACabinetAtTheWallIsClosedAndNothingInTheRoom) {
    EXPECT_GT(probability_closed(BesideWall{0.04}.looks()), 0.5);
    EXPECT_LT(probability_closed(BesideWall{0.4}.looks()), 0.5);
    EXPECT_LT(probability_closed({}), 0.5);
}

// A wardrobe of 0.9 x 0.5 x 1.8 m: boards of 18 mm on all six sides, less what they share at edges.
TEST(ClosedFurniture, WeighsItsBoardsAndContents) {
    const double volume = 0.9 * 0.5 * 1.8, side = 2 * (0.9 * 0.5 + 0.5 * 1.8 + 0.9 * 1.8);
    const FurnitureLooks looks{1.8, 1, 1, side};
    const double boards = side * 0.018, inside = volume - boards;
    const ClosedBody full = closed_body(looks, volume, 700, 68);
    EXPECT_NEAR(full.density_kg_m3 * volume, 700 * boards + 68 * inside, 1e-9);
    EXPECT_NEAR(full.error.mass_kg, 68 * inside / std::sqrt(3), 1e-9);
    EXPECT_GT(full.error.center_m[2], 0.05);
    EXPECT_LT(full.error.center_m[2], 0.9);
    EXPECT_EQ(full.error.center_m[0], 0);
    const ClosedBody empty = closed_body(looks, volume, 700, 0);
    EXPECT_NEAR(empty.density_kg_m3 * volume, 700 * boards, 1e-9);
    EXPECT_EQ(empty.error.mass_kg, 0);
    EXPECT_EQ(empty.error.center_m[2], 0);
}

// What a shell weighs lies farther out than an even solid of the same mass; filled with what it is
// made of, it is that solid.
TEST(ClosedFurniture, ShellsResistTurnsMoreThanSolids) {
    const FurnitureLooks looks{1, 1, 1, 6};
    const ClosedBody shell = closed_body(looks, 1, 700, 0);
    EXPECT_GT(shell.inertia_density_kg_m3, 1.5 * shell.density_kg_m3);
    // Of a thin cubic shell of mass m and edge a: 5 / 18 m a^2, where the solid has 1 / 6.
    EXPECT_NEAR(shell.inertia_density_kg_m3 / shell.density_kg_m3, 5.0 / 3, 0.07);
    const ClosedBody solid = closed_body(looks, 1, 700, 700);
    EXPECT_NEAR(solid.density_kg_m3, 700, 1e-9);
    EXPECT_NEAR(solid.inertia_density_kg_m3, 700, 1e-9);
}

TEST(ClosedFurniture, SmallThingsAreAllBoards) {
    const ClosedBody small = closed_body({0.03, 1, 1, 6 * 0.0009}, 0.000027, 700, 68);
    EXPECT_NEAR(small.density_kg_m3, 700, 1e-9);
    EXPECT_EQ(closed_body({}, 0, 700, 68).density_kg_m3, 0);
}

SolidScene scene_of(const std::vector<test::Solid>& solids, double voxel_m,
                    std::size_t primitives) {
    return SolidScene(test::voxelise(solids, {-1, -1, -1}, {1, 1, 1}, voxel_m),
                      std::vector<Role>(primitives, Role::none));
}

double shell_of_box(const Vec3& size, double wall) {
    double inside = 1;
    for (const double s : size) inside *= std::max(0.0, s - 2 * wall);
    return size[0] * size[1] * size[2] - inside;
}

// Of walls thinner than a voxel the edges, where two meet, count once.
TEST(HollowBody, HasTheVolumeOfItsShell) {
    const Vec3 size{0.6, 0.4, 0.8};
    const auto scene = scene_of({{0, test::box({-0.3, -0.2, -0.4}, {0.3, 0.2, 0.4})}}, 0.02, 1);
    const std::vector<std::int32_t> all{0};
    for (const auto& [wall, within] : {std::pair{0.005, 0.06},
                                       {0.01, 0.04},
                                       {0.02, 1e-9},
                                       {0.04, 0.02},
                                       {0.06, 0.02},
                                       {0.5, 1e-9}}) {
        const HollowBody body = hollow_body(scene, all, wall);
        const double expected = shell_of_box(size, wall);
        EXPECT_NEAR(body.volume_m3[0], expected, within * expected) << wall;
        for (const double c : body.center[0]) EXPECT_NEAR(c, 0, 1e-9);
    }
    // Of a box of thin walls: those of its six sides.
    const HollowBody body = hollow_body(scene, all, 0.02);
    const auto moment = [&](double a, double b) {  // of a solid box about its middle, over volume
        return (a * a + b * b) / 12;
    };
    const double outer = 0.6 * 0.4 * 0.8, inner = 0.56 * 0.36 * 0.76;
    EXPECT_NEAR(body.inertia_m5[0], outer * moment(0.4, 0.8) - inner * moment(0.36, 0.76), 1e-6);
    EXPECT_NEAR(body.inertia_m5[2], outer * moment(0.6, 0.4) - inner * moment(0.56, 0.36), 1e-6);
    for (std::size_t e = 3; e < 6; ++e) EXPECT_NEAR(body.inertia_m5[e], 0, 1e-9);
}

// Where two parts of one object meet there is no wall; the centre is that of the shell.
TEST(HollowBody, IsOneShellAroundAllParts) {
    const auto both = scene_of({{0, test::box({-0.2, -0.2, 0}, {0.2, 0.2, 0.2})},
                                {1, test::box({-0.2, -0.2, 0.2}, {0.2, 0.2, 0.6})},
                                {2, test::box({0.2, -0.2, 0}, {0.4, 0.2, 0.2})}},
                               0.02, 3);
    const HollowBody body = hollow_body(both, std::vector<std::int32_t>{0, 1}, 0.02);
    const double expected = shell_of_box({0.4, 0.4, 0.6}, 0.02);
    EXPECT_NEAR(body.volume_m3[0] + body.volume_m3[1], expected, 1e-6);
    double height = 0;
    for (const std::size_t n : {0u, 1u}) height += body.volume_m3[n] * body.center[n][2];
    EXPECT_NEAR(height / expected, 0.3, 1e-6);
    EXPECT_LT(body.center[0][2], 0.1);  // its floor is there
    EXPECT_TRUE(hollow_body(both, std::vector<std::int32_t>{}, 0.02).volume_m3.empty());
}

// Its surface is known to half a voxel.
TEST(HollowBody, OfABall) {
    const auto ball = scene_of(
        {{0, [](double x, double y, double z) { return x * x + y * y + z * z < 0.4 * 0.4; }}}, 0.02,
        1);
    const HollowBody body = hollow_body(ball, std::vector<std::int32_t>{0}, 0.05);
    const double expected = 4.0 / 3 * std::numbers::pi * (std::pow(0.4, 3) - std::pow(0.35, 3));
    EXPECT_NEAR(body.volume_m3[0], expected, 0.1 * expected);
}

FurnitureLooks box(double height, double depth, double width, double fill, double backing) {
    return {.height_m = height,
            .fill = fill,
            .backing = backing,
            .box_side_m2 = 0,
            .box_m = {depth, width}};
}

// Two bookcases, one with a wall behind it that was seen; a table; another, of which half was seen.
const std::vector<FurnitureLooks> things{box(2, 0.4, 1, 0.9, 1),
                                         box(2.1, 0.44, 1.05, 0.9, 0),
                                         box(0.75, 0.8, 1.6, 0.3, 0),
                                         box(2, 0.4, 0.5, 0.9, 0),
                                         {}};

TEST(Repeated, BoxesOfTheSameSidesAre) {
    const Repeated alike = find_repeated(things);
    EXPECT_EQ(alike[0], std::vector<std::int32_t>{1});
    EXPECT_EQ(alike[1], std::vector<std::int32_t>{0});
    for (const std::size_t other : {2u, 3u, 4u}) EXPECT_TRUE(alike[other].empty()) << other;
    EXPECT_TRUE(find_repeated(std::vector<FurnitureLooks>(2))[0].empty()) << "nothing has no box";
}

TEST(Repeated, AreClosedTogether) {
    const std::vector<ClosedOdds> p = closed_odds(things, find_repeated(things));
    const auto log_odds = [](double x) { return std::log(x / (1 - x)); };
    const double both = log_odds(probability_closed(things[0])) +
                        log_odds(probability_closed(things[1])) - log_odds(closed_share);
    EXPECT_GT(probability_closed(things[0]), 0.5);
    EXPECT_LT(probability_closed(things[1]), 0.5);
    EXPECT_NEAR(log_odds(p[0].probability), both, 1e-9);
    EXPECT_NEAR(log_odds(p[1].probability), both, 1e-9);
    EXPECT_NEAR(p[3].probability, probability_closed(things[3]), 1e-12);
    EXPECT_EQ(p[4].probability, 0);
}

// What fills too little of its box to tell has no say.
TEST(Repeated, NeedToFillTheirBoxes) {
    std::vector<FurnitureLooks> some{things[0], things[1]};
    some[1].fill = 0.1;
    const std::vector<ClosedOdds> p = closed_odds(some, find_repeated(some));
    EXPECT_NEAR(p[0].probability, probability_closed(some[0]), 1e-12);
    EXPECT_EQ(p[1].probability, 0);
}

// A wall that a voxel more or less brings within reach tells now one kind, now the other.
TEST(Repeated, WhereVoxelsFallMayTellTheOtherKind) {
    for (const double usual : {0.0, 1.0}) {
        FurnitureLooks near = box(1.2, 0.3, 0.3, 1, usual);
        const auto closed_ways = [&] {
            return closed_odds(std::vector<FurnitureLooks>{near}, Repeated(1))[0].closed_ways;
        };
        near.backing_range = {0, 1};
        EXPECT_NEAR(closed_ways(), (1 + usual) / 3, 1e-3);
        near.backing_range = {usual, usual};
        EXPECT_EQ(closed_ways(), usual);
    }
}

TEST(Repeated, MassesShowTheirError) {
    const std::vector<double> mass{50, 100, 3};
    const double off = std::log(2.0) / std::sqrt(2.0);
    const std::vector<std::int32_t> other{1};
    EXPECT_NEAR(error_among_alike_kg(mass, other, 0), 50 * (1 - std::exp(-off)), 1e-9);
    EXPECT_NEAR(error_among_alike_kg(mass, {}, 2), 0, 0);
    const std::vector<double> same{50, 50};
    EXPECT_EQ(error_among_alike_kg(same, other, 0), 0);
}

}  // namespace
}  // namespace topple::physics
