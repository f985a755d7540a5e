// SPDX-License-Identifier: MIT
#include "simulation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>

// That the simulator tells what stands from what falls, where that is known.
namespace topple::simulation {
namespace {

constexpr double side_m = 0.02;

std::vector<Cell> box(const Cell& low, const Cell& high) {
    std::vector<Cell> cells;
    for (std::int32_t i = low[0]; i < high[0]; ++i) {
        for (std::int32_t j = low[1]; j < high[1]; ++j) {
            for (std::int32_t k = low[2]; k < high[2]; ++k) cells.push_back({i, j, k});
        }
    }
    return cells;
}
const std::vector<Cell> table = box({-20, -20, -3}, {20, 20, 0});

double moved(const LooseBody& body, const std::vector<Cell>& fixed, const Vec3& impulse_Ns = {}) {
    Simulation simulation(body, fixed, 0.3);
    simulation.push(impulse_Ns);
    simulation.run(2, 0.5);
    const Vec3 by = simulation.moved_m();
    return std::sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
}

TEST(Simulation, ABoxStandsAsLongAsItsCentreIsOverTheTable) {
    // 10 voxels deep, 2 voxels more or less of it over the edge.
    for (const std::int32_t out : {3, 4, 6, 7}) {
        const LooseBody body{side_m, 700, {box({10 + out, 0, 0}, {20 + out, 5, 8})}};
        const double by = moved(body, table);
        if (out < 5)
            EXPECT_LT(by, 0.003) << out;
        else
            EXPECT_GT(by, 0.3) << out;
    }
}

TEST(Simulation, APushedBoxSlidesAsFarAsItsFrictionLetsIt) {
    const LooseBody body{side_m, 700, {box({-15, 0, 0}, {-5, 10, 4})}};
    const double mass = Simulation(body, table, 0.3).mass_kg();
    EXPECT_NEAR(mass, 700 * 400 * side_m * side_m * side_m, 1e-9);
    const double speed = 0.7, distance = speed * speed / (2 * 0.3 * 9.80665);
    EXPECT_NEAR(moved(body, table, {speed * mass, 0, 0}), distance, 0.05 * distance);
}

TEST(Simulation, RoughSidesThatInterlockDoNotThrowItOut) {
    // A box whose underside reaches into the table by every other voxel.
    std::vector<Cell> part = box({0, 0, 0}, {10, 10, 10}), fixed = table;
    for (std::int32_t i = 0; i < 10; ++i) {
        for (std::int32_t j = (i + 1) % 2; j < 10; j += 2) {
            part.push_back({i, j, -1});
            std::erase(fixed, Cell{i, j, -1});
        }
    }
    EXPECT_LT(moved({side_m, 700, {part}}, fixed), 0.003);
    // It falls through a gap.
    std::erase_if(fixed, [](const Cell& c) { return c[0] >= -1 && c[0] <= 10; });
    EXPECT_GT(moved({side_m, 700, {part}}, fixed), 0.3);
}

}  // namespace
}  // namespace topple::simulation
