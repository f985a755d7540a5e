// SPDX-License-Identifier: MIT
#include "physics/rectangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace topple::physics {
namespace {

using Corners = std::vector<std::array<double, 2>>;

TEST(SmallestRectangle, OfATurnedRectangleIsItself) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    Corners polygon;
    for (const auto& [x, y] : {std::array{-2.0, -0.5}, {2.0, -0.5}, {2.0, 0.5}, {-2.0, 0.5}})
        polygon.push_back({3 + c * x - s * y, 1 + s * x + c * y});
    const Rectangle r = smallest_rectangle(polygon);
    EXPECT_NEAR(r.area(), 4, 1e-12);
    EXPECT_NEAR(r.middle[0], 3, 1e-12);
    EXPECT_NEAR(r.middle[1], 1, 1e-12);
    EXPECT_NEAR(std::abs(r.axes[0][0] * c + r.axes[0][1] * s), 1, 1e-12);
    EXPECT_NEAR(r.half[0], 2, 1e-12);
    EXPECT_NEAR(r.half[1], 0.5, 1e-12);
}

// Of all turns of a box around a triangle none is smaller.
TEST(SmallestRectangle, NoTurnIsSmaller) {
    const Corners triangle{{0, 0}, {3, 0.5}, {1, 2}};
    const double least = smallest_rectangle(triangle).area();
    for (int n = 0; n < 900; ++n) {
        const double angle = 1e-3 * n * 3.1416 / 1.8, c = std::cos(angle), s = std::sin(angle);
        double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
        for (const auto& [x, y] : triangle) {
            const double at[2] = {c * x + s * y, c * y - s * x};
            for (int a = 0; a < 2; ++a) {
                low[a] = std::min(low[a], at[a]);
                high[a] = std::max(high[a], at[a]);
            }
        }
        EXPECT_GE((high[0] - low[0]) * (high[1] - low[1]), least - 1e-9);
    }
}

TEST(SmallestRectangle, WithoutAnAreaThereIsNone) {
    EXPECT_EQ(smallest_rectangle(Corners{}).area(), 0);
    EXPECT_EQ(smallest_rectangle(Corners{{1, 2}}).area(), 0);
    EXPECT_EQ(smallest_rectangle(Corners{{1, 2}, {2, 2}}).area(), 0);
}

}  // namespace
}  // namespace topple::physics
