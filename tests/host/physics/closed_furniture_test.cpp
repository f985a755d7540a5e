// SPDX-License-Identifier: MIT
#include "physics/closed_furniture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "device/devices.h"
#include "host/physics/solids.h"

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

}  // namespace
}  // namespace topple::physics
