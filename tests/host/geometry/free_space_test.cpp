// SPDX-License-Identifier: MIT
#include "geometry/free_space.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "clouds.h"
#include "host/geometry/split_scenes.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;
using scenes::Builder;

PointCloud cloud_of(const Builder& scene) {
    const PointCloud cloud = test::cloud_of(scene.points);
    return cloud;
}

TEST(FreeSpace, WithoutViewpointsNothingIsKnown) {
    Builder scene;
    scene.face({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    ThreadPool threads(2);
    const FreeSpace free(scene.surfels(), cloud_of(scene), {}, {}, threads);
    EXPECT_FALSE(free.known());
    EXPECT_FALSE(free.at({0.5, 0.5, 0.5}));
    EXPECT_FALSE(FreeSpace().between({0, 0, 1}, {1, 1, 1}));
}

TEST(FreeSpace, ReachesFromTheSensorToTheSurfaceAndNoFurther) {
    Builder scene;
    scene.face({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    scene.box({-0.2, -0.2, 0.0}, {0.4, 0.4, 0.6}, 1);
    scene.face({1, -1, 0}, {0, 0, 1.5}, {0, 2, 0}, 2);
    const Vec3 eye{0, 0, 2};
    ThreadPool threads(2);
    const FreeSpace free(scene.surfels(), cloud_of(scene), {&eye, 1}, {}, threads);
    EXPECT_TRUE(free.known());
    EXPECT_TRUE(free.at({0, 0, 0.9}));
    EXPECT_TRUE(free.at({0.7, 0, 0.3}));
    EXPECT_FALSE(free.at({0, 0, 0.3})) << "in the box";
    EXPECT_FALSE(free.at({0.7, 0, 0.0})) << "at the floor";
    EXPECT_FALSE(free.at({9, 9, 9})) << "outside of the grid";
    EXPECT_TRUE(free.between({-0.9, 0, 0}, {-0.2, 0, 0.6}));
    EXPECT_FALSE(free.between({-0.2, 0, 0.1}, {0.2, 0, 0.5})) << "through the box";
}

// Viewpoints may be guesses: what no sensor can have seen from there is no evidence.
TEST(FreeSpace, LinesThroughASurfaceTellNothing) {
    Builder scene;
    scene.face({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    scene.face({-0.6, -0.6, 1}, {1.2, 0, 0}, {0, 1.2, 0}, 1);
    scene.face({0.7, -1, 0}, {0, 0, 1.8}, {0, 2, 0}, 2);
    const Vec3 eye{0, 0, 2};
    ThreadPool threads(2);
    const FreeSpace free(scene.surfels(), cloud_of(scene), {&eye, 1}, {}, threads);
    EXPECT_TRUE(free.at({0, 0, 1.4}));
    EXPECT_FALSE(free.at({0, 0, 0.5}));
}

TEST(FreeSpace, AStrayFarAwayDoesNotCoarsenIt) {
    Builder scene;
    scene.face({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    scene.face({1, -1, 0}, {0, 0, 1.5}, {0, 2, 0}, 1);
    const Vec3 eye{0, 0, 2};
    ThreadPool threads(2);
    const FreeSpace before(scene.surfels(), cloud_of(scene), {&eye, 1}, {}, threads);
    for (const double side : {-1, 1}) scene.point({side * 6000, 7000, side * 5000}, {0, 0, 1}, 2);
    const FreeSpace free(scene.surfels(), cloud_of(scene), {&eye, 1}, {}, threads);
    EXPECT_EQ(free.cell_m(), before.cell_m());
    EXPECT_TRUE(free.at({0, 0, 0.9}));
    EXPECT_FALSE(free.at({0, 0, 0}));
}

TEST(FreeSpace, TheOrderOfPointsAndTheirViewpointsDoesNotMatter) {
    Builder scene;
    scene.face({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    const std::vector<Vec3> eyes{{0, 0, 2}, {0.5, 0, 1}};
    std::vector<std::uint32_t> seen_from;
    for (std::size_t i = 0; i < scene.points.size(); ++i)
        seen_from.push_back(static_cast<std::uint32_t>(i % 2));
    ThreadPool threads(2);
    const FreeSpace free(scene.surfels(), cloud_of(scene), eyes, seen_from, threads);
    std::reverse(scene.points.begin(), scene.points.end());
    std::reverse(seen_from.begin(), seen_from.end());
    const FreeSpace turned(scene.surfels(), cloud_of(scene), eyes, seen_from, threads);
    for (double x = -1; x < 1; x += 0.07)
        for (double z = 0; z < 2; z += 0.07)
            EXPECT_EQ(free.at({x, 0.01, z}), turned.at({x, 0.01, z})) << x << ' ' << z;
}

}  // namespace
}  // namespace topple::geometry
