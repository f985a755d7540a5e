// SPDX-License-Identifier: MIT
#include "geometry/storeys.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace topple::geometry {
namespace {

constexpr double step_m = 0.025, low_m = -0.5;

// Surface by height: a little everywhere, and these levels (height, square metres).
std::vector<double> histogram(const std::vector<std::pair<double, double>>& levels) {
    std::vector<double> area(600, 0.4);
    for (const auto& [height, m2] : levels)
        area[static_cast<std::size_t>(std::floor((height - low_m) / step_m))] += m2;
    return area;
}

TEST(Storeys, AreCutInTheSlabs) {
    const auto storeys = find_storeys(
        histogram({{0.01, 90}, {2.71, 88}, {3.11, 90}, {5.81, 90}, {6.21, 60}, {8.9, 60}}), low_m,
        step_m);
    ASSERT_EQ(storeys.size(), 3u);
    EXPECT_NEAR(storeys[0].floor_m, 0.01, 0.05);
    EXPECT_TRUE(std::isinf(storeys[0].below_m));
    EXPECT_NEAR(storeys[1].floor_m, 3.11, 0.05);
    EXPECT_NEAR(storeys[1].below_m, 2.91, 0.05);
    EXPECT_NEAR(storeys[2].floor_m, 6.21, 0.05);
    EXPECT_NEAR(storeys[2].below_m, 6.01, 0.05);
}

TEST(Storeys, TablesAndLoweredCeilingsAreNone) {
    const auto storeys =
        find_storeys(histogram({{0, 80}, {0.75, 30}, {2.4, 30}, {2.7, 50}}), low_m, step_m);
    // The ceiling at two heights passes for a slab: what lies above it is empty.
    ASSERT_GE(storeys.size(), 1u);
    EXPECT_NEAR(storeys[0].floor_m, 0, 0.05);
    for (std::size_t s = 1; s < storeys.size(); ++s) EXPECT_GT(storeys[s].below_m, 2.3);
}

// One level of a scan without noise, wherever it lies in the histogram's steps, is one.
TEST(Storeys, ASharpCeilingIsNoSlab) {
    for (double offset = 0; offset < step_m; offset += 0.004) {
        const auto storeys =
            find_storeys(histogram({{0.01 + offset, 90}, {2.7 + offset, 88}, {2.72 + offset, 3}}),
                         low_m, step_m);
        EXPECT_EQ(storeys.size(), 1u) << offset;
    }
}

TEST(Storeys, AScanWithoutCeilingIsOne) {
    const auto storeys = find_storeys(histogram({{0.3, 50}}), low_m, step_m);
    ASSERT_EQ(storeys.size(), 1u);
    EXPECT_NEAR(storeys[0].floor_m, 0.3, 0.05);
}

TEST(Storeys, NothingIsOneStoreyWithoutFloor) {
    const auto storeys = find_storeys({}, 0, step_m);
    ASSERT_EQ(storeys.size(), 1u);
    EXPECT_TRUE(std::isnan(storeys[0].floor_m));
}

}  // namespace
}  // namespace topple::geometry
