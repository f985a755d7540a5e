// SPDX-License-Identifier: MIT
#include "export/convex_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/vectors.h"
#include "host/export/blocks.h"

namespace topple::exports::test {
namespace {

TEST(ConvexPart, OfABoxHasItsVolumeFacesAndExtent) {
    const ConvexPart part = block({1, 2, 3}, {2, 4, 6});
    EXPECT_NEAR(part.volume_m3, 6, 1e-12);
    EXPECT_EQ(part.corner.size(), 8u);
    EXPECT_EQ(part.face.size(), 6u);
    const Extent along = extent_along(part, {0, 0, 1});
    EXPECT_EQ(along.low, 3);
    EXPECT_EQ(along.high, 6);
}

TEST(ConvexPart, CutsLeaveWhatIsInTheHalfSpace) {
    const ConvexPart part = block({0, 0, 0}, {1, 1, 1});
    const double s = std::sqrt(0.5);
    const auto half = cut(part, {{s, s, 0}, s});  // x + y <= 1
    ASSERT_TRUE(half);
    EXPECT_NEAR(half->volume_m3, 0.5, 1e-9);
    for (const Vec3& p : half->solid) EXPECT_LE(p[0] + p[1], 1 + 2 * on_plane_m);
    EXPECT_FALSE(cut(part, {{0, 0, 1}, -0.1}));
    EXPECT_EQ(cut(part, {{0, 0, 1}, 2})->volume_m3, part.volume_m3);
}

// Cut again and again, also through corners and along faces, as Qhull would have it.
TEST(ConvexPart, ManyCutsAreTheHullOfWhatTheyLeave) {
    std::mt19937 random(7);
    const auto number = [&] { return static_cast<double>(random()) / 4294967296.0 * 2 - 1; };
    for (int round = 0; round < 200; ++round) {
        ConvexPart part = block({-1, -1, -1}, {1, 1, 1});
        for (int n = 0; n < 12; ++n) {
            Vec3 normal = unit({number(), number(), number()});
            if (n % 3 == 1) normal = {0, n % 2 == 1 ? 1.0 : -1.0, 0};
            double offset = 0.4 + 0.5 * std::abs(number());
            if (n % 4 == 2) offset = dot(normal, part.corner[random() % part.corner.size()]);
            const auto left = cut(part, {normal, offset});
            if (!left) break;
            const auto hull = hull_part(left->corner);
            ASSERT_TRUE(hull);
            ASSERT_NEAR(left->volume_m3, hull->volume_m3, 1e-9);
            ASSERT_LE(extent_along(*left, normal).high, offset + 1e-7);
            part = *left;
        }
    }
}

TEST(ConvexPart, ShrinksOnAllSidesUnlessNothingIsLeft) {
    const ConvexPart part = block({0, 0, 0}, {1, 2, 3});
    EXPECT_NEAR(shrunk(part, 0.1).volume_m3, 0.8 * 1.8 * 2.8, 1e-9);
    EXPECT_EQ(shrunk(part, 0.6).volume_m3, part.volume_m3);
}

TEST(ConvexPart, WithoutVolumeIsNone) {
    EXPECT_FALSE(hull_part(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
    EXPECT_FALSE(hull_part(std::vector<Vec3>{}));
}

TEST(ConvexPart, ATurnedBoxIsOneAndAWedgeIsNot) {
    const double c = std::cos(0.4), s = std::sin(0.4);
    std::vector<Vec3> turned;
    for (const Vec3& v : block({-0.5, -1, -2}, {0.5, 1, 2}).corner)
        turned.push_back({c * v[0] - s * v[1] + 3, s * v[0] + c * v[1], v[2]});
    const auto box = as_box(*hull_part(turned), 1e-6);
    ASSERT_TRUE(box);
    EXPECT_NEAR(8 * box->half_m[0] * box->half_m[1] * box->half_m[2], 8, 1e-9);
    EXPECT_NEAR(box->center[0], 3, 1e-9);
    const auto wedge = cut(*hull_part(turned), {{0, 0.6, 0.8}, 0.5});
    EXPECT_FALSE(as_box(*wedge, 1e-3));
}

}  // namespace
}  // namespace topple::exports::test
