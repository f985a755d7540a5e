// SPDX-License-Identifier: MIT
#include "geometry/surface_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "clouds.h"
#include "random.h"

namespace topple::geometry {
namespace {

// Points with a surfel each.
struct ScannedPoints {
    PointCloud cloud;
    Surfels surfels;
    std::vector<std::int32_t> primitive;
    SceneFrame frame{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, true, "", "", 0};

    void add(const Vec3& p, const Vec3& normal, std::int32_t of = 0) {
        test::add(cloud, p);
        surfels.of_point.push_back(static_cast<std::uint32_t>(surfels.nx.size()));
        test::add_normal(surfels, normal);
        primitive.push_back(of);
    }
    void colour(float l, float a, float b) {
        surfels.lab_l.push_back(l);
        surfels.lab_a.push_back(a);
        surfels.lab_b.push_back(b);
    }
    SurfaceSamples samples(double edge_m) const {
        ThreadPool threads(2);
        return sample_surface(cloud, surfels, primitive, frame, edge_m, threads);
    }
};

TEST(SurfaceSamples, AreTheMeansOfThePointsInEachCell) {
    ScannedPoints scan;
    scan.add({0.25, 0.25, 0.25}, {0, 0, 1});
    scan.add({0.75, 0.5, 0.25}, {1, 0, 0});
    scan.add({1.25, 0.5, 0.25}, {0, 0, 1});
    scan.add({-0.25, 0.5, 0.25}, {0, 0, -1});
    scan.add({0.5, 0.5, 0.5}, {0, 1, 0}, 1);  // another primitive in the first one's cell
    scan.add({0.5, 0.5, 0.5}, {0, 1, 0}, -1);
    const SurfaceSamples s = scan.samples(1);
    ASSERT_EQ(s.size(), 5u);
    EXPECT_EQ(s.primitive, (std::vector<std::int32_t>{-1, 0, 0, 0, 1}));
    EXPECT_EQ(s.x, (std::vector<float>{0.5f, -0.25f, 0.5f, 1.25f, 0.5f}));
    EXPECT_EQ(s.y, (std::vector<float>{0.5f, 0.5f, 0.375f, 0.5f, 0.5f}));
    EXPECT_EQ(s.z, (std::vector<float>{0.5f, 0.25f, 0.25f, 0.25f, 0.5f}));
    EXPECT_FLOAT_EQ(s.nx[2], std::sqrt(0.5f)) << "the mean of both, of unit length";
    EXPECT_FLOAT_EQ(s.nz[2], std::sqrt(0.5f));
    EXPECT_EQ(s.nz[1], -1);
    EXPECT_EQ(s.edge_m, 1);
    EXPECT_FALSE(s.coloured());
    EXPECT_EQ(SurfaceSamples().size(), 0u);
    EXPECT_EQ(ScannedPoints().samples(0.02).spacing_m, 0.02) << "nothing to measure";
}

TEST(SurfaceSamples, OppositeNormalsLeaveNone) {
    ScannedPoints scan;
    scan.add({0.5, 0.5, 0.5}, {0, 0, 1});
    scan.add({0.6, 0.5, 0.5}, {0, 0, -1});
    const SurfaceSamples s = scan.samples(1);
    EXPECT_EQ(s.nx[0], 0);
    EXPECT_EQ(s.ny[0], 0);
    EXPECT_EQ(s.nz[0], 0);
}

// The scene's axes: x towards the input's y, and so on.
TEST(SurfaceSamples, AreInTheScenesFrame) {
    ScannedPoints scan;
    scan.frame.axes = {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
    scan.add({0.125, 0.25, 0.5}, {1, 0, 0});
    const SurfaceSamples s = scan.samples(1);
    EXPECT_EQ(s.x[0], 0.25f);
    EXPECT_EQ(s.y[0], 0.5f);
    EXPECT_EQ(s.z[0], 0.125f);
    EXPECT_EQ(s.nz[0], 1);
}

// Points of a square of 3 m, one for each square of `side_m` on average.
ScannedPoints scattered_points(double side_m, std::uint64_t seed) {
    test::Random random(seed);
    ScannedPoints scan;
    const auto count = static_cast<int>(9 / (side_m * side_m));
    for (int n = 0; n < count; ++n) {
        const double x = 3 * random.uniform(), y = 3 * random.uniform();
        scan.add({x, y, 0.011}, {0, 0, 1}, static_cast<std::int32_t>(random.word() % 3));
    }
    return scan;
}

TEST(SurfaceSamples, TheSpacingIsThatOfThePointsWhereTheyAreSparse) {
    constexpr double edge_m = 0.02;
    for (const double side_m : {0.03, 0.04, 0.05}) {
        for (const std::uint64_t seed : {1u, 2u}) {
            ScannedPoints scan = scattered_points(side_m, seed);
            std::ranges::fill(scan.primitive, 0);
            EXPECT_NEAR(scan.samples(edge_m).spacing_m, side_m, 0.15 * side_m) << side_m;
        }
    }
}

TEST(SurfaceSamples, TheSpacingIsThatOfTheCellsWhereTheyAreDense) {
    ScannedPoints scan = scattered_points(0.01, 1);
    std::ranges::fill(scan.primitive, 0);
    for (const double edge_m : {0.03, 0.05}) {
        const SurfaceSamples s = scan.samples(edge_m);
        EXPECT_GE(s.spacing_m, edge_m);
        EXPECT_LT(s.spacing_m, 1.15 * edge_m);
        EXPECT_NEAR(static_cast<double>(s.size()) * s.spacing_m * s.spacing_m, 9, 0.3 * 9);
    }
}

TEST(SurfaceSamples, ColoursAreMeansOfThoseThatAreKnown) {
    const float none = std::numeric_limits<float>::quiet_NaN();
    ScannedPoints scan;
    for (const double x : {0.25, 0.5, 0.75, 1.5}) scan.add({x, 0.5, 0.5}, {0, 0, 1});
    scan.colour(10, -3, 4);
    scan.colour(30, -5, 0);
    scan.colour(none, none, none);
    scan.colour(none, none, none);
    const SurfaceSamples s = scan.samples(1);
    ASSERT_TRUE(s.coloured());
    EXPECT_FLOAT_EQ(s.lab_l[0], 20);
    EXPECT_FLOAT_EQ(s.lab_a[0], -4);
    EXPECT_FLOAT_EQ(s.lab_b[0], 2);
    EXPECT_TRUE(std::isnan(s.lab_l[1]) && std::isnan(s.lab_a[1]) && std::isnan(s.lab_b[1]));
}

TEST(SurfaceSamples, AreSelectedAndSortedWithAllThatTheyHold) {
    ScannedPoints scan;
    for (const std::int32_t n : {0, 1, 2, 3}) {
        scan.add({n + 0.5, 0.5, 0.5}, {0, 0, 1}, n % 2);
        scan.colour(static_cast<float>(n), 0, 0);
    }
    SurfaceSamples s = scan.samples(1);
    EXPECT_EQ(s.primitive, (std::vector<std::int32_t>{0, 0, 1, 1}));
    EXPECT_EQ(s.lab_l, (std::vector<float>{0, 2, 1, 3}));
    const SurfaceSamples right = samples_where(s, [&](std::size_t n) { return s.x[n] > 2; });
    EXPECT_EQ(right.lab_l, (std::vector<float>{2, 3}));
    EXPECT_EQ(right.primitive, (std::vector<std::int32_t>{0, 1}));
    EXPECT_EQ(right.spacing_m, s.spacing_m);
    EXPECT_EQ(right.edge_m, s.edge_m);
    s.primitive = {3, 1, 3, 0};
    sort_by_primitive(s);
    EXPECT_EQ(s.primitive, (std::vector<std::int32_t>{0, 1, 3, 3}));
    EXPECT_EQ(s.lab_l, (std::vector<float>{3, 2, 0, 1})) << "equals in their order";
    EXPECT_EQ(s.x, (std::vector<float>{3.5f, 2.5f, 0.5f, 1.5f}));
}

}  // namespace
}  // namespace topple::geometry
