// SPDX-License-Identifier: MIT
#include "points/working_origin.h"

#include <algorithm>
#include <cmath>

#include "clouds.h"
#include "core/vectors.h"
#include "standard.h"
#include "topple/kernel_testing/random.h"

namespace topple::test {
namespace {

// A floor at z = 0.313, a wall at x = -1.207, and things at random between; noise of 3 mm.
std::vector<Vec3> room_points(std::uint64_t seed, std::size_t count) {
    Random random(seed);
    std::vector<Vec3> out;
    for (std::size_t n = 0; n < count; ++n) {
        Vec3 p{random.uniform(-1.2F, 2.4F), random.uniform(0.0F, 3.0F),
               random.uniform(0.32F, 2.8F)};
        if (n % 4 < 2) p[2] = 0.313 + 0.003 * random.normal();
        if (n % 4 == 2) p[0] = -1.207 + 0.003 * random.normal();
        out.push_back(p);
    }
    return out;
}

TEST(WorkingOrigin, LiesOnTheDensestPlanes) {
    const PointCloud cloud = cloud_of(room_points(1, 20000));
    const Vec3 planes = densest_planes(cloud);
    EXPECT_NEAR(planes[2], 0.313, 2e-4);
    EXPECT_NEAR(planes[0], -1.207, 3e-4);
}

TEST(WorkingOrigin, MovesWithTheCloud) {
    std::vector<Vec3> points = room_points(2, 4000);
    const Vec3 before = densest_planes(cloud_of(points)), by{0.005, -3.1, 0.0173};
    for (Vec3& p : points) p = plus(p, by);
    const Vec3 after = densest_planes(cloud_of(points));
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(after[a] - before[a], by[a], 1e-5) << a;
}

TEST(WorkingOrigin, IsTheSameInAnyOrder) {
    std::vector<Vec3> points = room_points(3, 4000);
    const Vec3 before = densest_planes(cloud_of(points));
    std::ranges::reverse(points);
    EXPECT_EQ(densest_planes(cloud_of(points)), before);
}

TEST(WorkingOrigin, OfHalfThePointsIsNearlyTheSame) {
    const std::vector<Vec3> points = room_points(4, 20000);
    std::vector<Vec3> half;
    for (const Vec3& p : points)
        if (std::fmod(std::abs(p[1]), 0.02) < 0.01) half.push_back(p);
    const Vec3 all = densest_planes(cloud_of(points)), some = densest_planes(cloud_of(half));
    EXPECT_NEAR(some[2], all[2], 3e-4);
    EXPECT_NEAR(some[0], all[0], 5e-4);
}

TEST(WorkingOrigin, IsFoundOfOnePointAndOfFarOnes) {
    EXPECT_LT(length(minus(densest_planes(cloud_of({Vec3{1, 2, 3}})), {1, 2, 3})), 2e-6);
    const Vec3 planes = densest_planes(cloud_of({Vec3{0, 0, 0}, {0, 0, 1e6}, {0, 0, 1e6}}));
    EXPECT_NEAR(planes[2], 1e6, 1);
}

TEST(WorkingOrigin, PlanesLieAmidVoxels) {
    EXPECT_EQ(origin_amid_voxels({1, 0, -1}, 0.5), (Vec3{0.75, -0.25, -1.25}));
}

TEST(WorkingOrigin, CoordinatesAndSensorsAreReckonedFromThere) {
    PointCloud cloud = cloud_of({Vec3{1, 2, 3}, {4, 5, 6}});
    cloud.has_viewpoint = true;
    cloud.viewpoint = {0.5, 0, 0};
    Observation input;
    input.own = cloud;
    input.cloud = input.own;
    reckon_from({9, 9, 9}, input);
    reckon_from({1, -1, 0.5}, input);
    EXPECT_EQ(input.cloud.viewpoint, (Vec3{-0.5, 1, -0.5}));
    EXPECT_EQ(input.cloud.x[1], 3);
    EXPECT_EQ(input.cloud.y[1], 6);
    EXPECT_EQ(input.cloud.z[1], 5.5F);
    EXPECT_EQ(input.own.x[1], 4);
}

}  // namespace
}  // namespace topple::test
