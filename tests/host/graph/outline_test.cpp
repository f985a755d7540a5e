// SPDX-License-Identifier: MIT
#include "graph/outline.h"

#include <gtest/gtest.h>

namespace topple::graph {
namespace {

TEST(Outline, HasTheErrorOfItsCornersAlone) {
    const std::vector<BorderPoint> points{
        {{0, 0}, 0.01}, {{1, 0}, 0.02}, {{1, 1}, 0.03}, {{0, 1}, 0.02}, {{0.5, 0.5}, 1}};
    const Outline out = outline_of(points);
    EXPECT_EQ(out.polygon.size(), 4u);
    EXPECT_NEAR(out.error_m, 0.02, 1e-12);
}

// Where a corner is known twice, the better one counts.
TEST(Outline, TakesTheBetterOfTwo) {
    std::vector<BorderPoint> points;
    add_points({{0, 0}, {1, 0}, {0, 1}}, 0.01, points);
    add_points({{0, 0}, {1, 0}, {0, 1}}, 0.001, points);
    EXPECT_NEAR(outline_of(points).error_m, 0.001, 1e-12);
    EXPECT_TRUE(outline_of({}).polygon.empty());
}

}  // namespace
}  // namespace topple::graph
