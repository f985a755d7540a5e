// SPDX-License-Identifier: MIT
#include "export/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/vectors.h"
#include "export/turned.h"
#include "host/export/blocks.h"
#include "host/export/round_parts.h"

namespace topple::exports::test {
namespace {

TEST(Shape, APrismOfManySidesIsACylinderUprightOrNot) {
    for (const Vec3& axis : {Vec3{0, 0, 1}, Vec3{0.6, 0, 0.8}, Vec3{1, 0, 0}}) {
        const ConvexPart part = *hull_part(prism({1, 2, 3}, axis, 0.04, 0.1, 32));
        const auto cylinder = as_cylinder(part, round_tolerance_m);
        ASSERT_TRUE(cylinder);
        EXPECT_NEAR(cylinder->half_m, 0.1, 1e-9);
        EXPECT_NEAR(std::abs(dot(cylinder->axis, axis)), 1, 1e-9);
        EXPECT_NEAR(cylinder->center[0], 1, 1e-9);
        EXPECT_NEAR(cylinder->radius_m, 0.04, round_tolerance_m);
        EXPECT_TRUE(std::holds_alternative<Cylinder>(shape_of(part)));
    }
}

// What it touches, or nearly so, is as far from it as from the part.
TEST(Shape, ACylinderReachesNoFurtherThanItsPart) {
    const ConvexPart part = *hull_part(prism({0, 0, 0.1}, {0, 0, 1}, 0.05, 0.1, 24));
    const auto cylinder = as_cylinder(part, round_tolerance_m);
    ASSERT_TRUE(cylinder);
    for (int n = 0; n < 360; ++n) {
        const double angle = n * std::numbers::pi / 180;
        const Vec3 direction{std::cos(angle), std::sin(angle), 0};
        EXPECT_NEAR(cylinder->radius_m, extent_along(part, direction).high, round_tolerance_m);
    }
    EXPECT_NEAR(cylinder->center[2] - cylinder->half_m, 0, 1e-9);
}

TEST(Shape, WhatIsCoarseLeansOrTapersIsNoCylinder) {
    EXPECT_FALSE(as_cylinder(*hull_part(prism({}, {0, 0, 1}, 0.04, 0.1, 8)), round_tolerance_m));
    EXPECT_FALSE(as_cylinder(block({0, 0, 0}, {1, 1, 1}), round_tolerance_m));
    auto cone = prism({}, {0, 0, 1}, 0.04, 0.1, 32);
    for (Vec3& p : cone)
        if (p[2] > 0) p = {0.9 * p[0], 0.9 * p[1], p[2]};
    EXPECT_FALSE(as_cylinder(*hull_part(cone), round_tolerance_m));
    auto slanted = prism({}, {0, 0, 1}, 0.04, 0.1, 32);
    for (Vec3& p : slanted)
        if (p[2] > 0) p[2] += 0.1 * p[0];
    EXPECT_FALSE(as_cylinder(*hull_part(slanted), round_tolerance_m));
}

TEST(Shape, ABallIsASphereAndAnEggIsNone) {
    const auto sphere = as_sphere(*hull_part(ball({1, 2, 3}, 0.03, 40)), round_tolerance_m);
    ASSERT_TRUE(sphere);
    EXPECT_NEAR(sphere->radius_m, 0.03, round_tolerance_m);
    EXPECT_NEAR(sphere->center[2], 3, 1e-4);
    auto egg = ball({}, 0.03, 40);
    for (Vec3& p : egg) p[2] *= 1.1;
    EXPECT_FALSE(as_sphere(*hull_part(egg), round_tolerance_m));
    EXPECT_FALSE(as_sphere(block({0, 0, 0}, {0.1, 0.1, 0.1}), round_tolerance_m));
}

TEST(Shape, ABoxAlongTheAxesIsNotTurned) {
    const Shape shape = shape_of(block({0, 0, 0}, {3, 1, 2}));
    ASSERT_TRUE(std::holds_alternative<Box>(shape));
    const Box& box = std::get<Box>(shape);
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(box.axis[a][a], 1, 1e-12);
    EXPECT_NEAR(box.half_m[0], 1.5, 1e-12);
    EXPECT_NEAR(box.half_m[1], 0.5, 1e-12);
    EXPECT_NEAR(box.half_m[2], 1, 1e-12);
}

// Turns about x, then y, then z, each about the fixed axis.
Axes turned_by(const Vec3& rpy) {
    Axes out{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    for (std::size_t about = 0; about < 3; ++about) {
        const double c = std::cos(rpy[about]), s = std::sin(rpy[about]);
        const std::size_t u = (about + 1) % 3, v = (about + 2) % 3;
        for (Vec3& axis : out) {
            const Vec3 was = axis;
            axis[u] = c * was[u] - s * was[v];
            axis[v] = s * was[u] + c * was[v];
        }
    }
    return out;
}

TEST(Turned, AnglesAndQuaternionsGiveTheAxesAgain) {
    constexpr double right = std::numbers::pi / 2;
    for (const Vec3& rpy : {Vec3{}, Vec3{0.3, 0.4, 0.5}, Vec3{3, -1.5, -2}, Vec3{0.2, right, 0.7},
                            Vec3{1, -right, 2}, Vec3{0, right - 1e-9, 1}}) {
        const Axes axes = turned_by(rpy);
        const Axes again = turned_by(roll_pitch_yaw(axes));
        const auto [w, x, y, z] = quaternion(axes);
        // Its first column.
        const Vec3 first{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
        for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_NEAR(first[a], axes[0][a], 1e-12);
            for (std::size_t b = 0; b < 3; ++b) EXPECT_NEAR(again[a][b], axes[a][b], 1e-9);
        }
        EXPECT_GE(w, 0);
    }
}

}  // namespace
}  // namespace topple::exports::test
