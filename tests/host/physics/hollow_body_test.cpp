// SPDX-License-Identifier: MIT
#include "physics/hollow_body.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/physics/solids.h"

namespace topple::physics {
namespace {

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

}  // namespace
}  // namespace topple::physics
