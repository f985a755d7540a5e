// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "physics/merge_close_points.h"

namespace topple::physics {
namespace {

TEST(Weld, KeepsTheFirstOfPointsThatAreAllButTheSame) {
    const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1e-4, 0, 0}, {1, 0, 2e-3}, {1, 1e-4, 0}};
    const std::vector<Vec3> kept{{0, 0, 0}, {1, 0, 0}, {1, 0, 2e-3}};
    EXPECT_EQ(merge_close_points(points, 1e-3), kept);
    EXPECT_EQ(merge_close_points(points, 1e-6), points);
    EXPECT_TRUE(merge_close_points({}, 1e-3).empty());
}

// Two points may be close and yet in different cells of whatever grid finds them.
TEST(Weld, DoesNotDependOnWherePointsLie) {
    for (int n = -50; n < 50; ++n) {
        const double x = 0.00137 * n;
        EXPECT_EQ(merge_close_points({{x, -x, x}, {x + 5e-4, -x, x - 5e-4}}, 1e-3).size(), 1u) << n;
        EXPECT_EQ(merge_close_points({{x, -x, x}, {x + 1.1e-3, -x, x}}, 1e-3).size(), 2u) << n;
    }
}

}  // namespace
}  // namespace topple::physics
