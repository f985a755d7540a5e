// SPDX-License-Identifier: MIT
#include "solids/patches.h"

#include "clouds.h"
#include "core/thread_pool.h"
#include "geometry/algebraic_model.h"
#include "testing.h"
#include "topple/kernel_testing/random.h"

namespace topple::solids {
namespace {

using Eigen::Vector3d;
const std::array<Vec3, 3> as_is{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

struct Sampled {
    PointCloud cloud;
    std::vector<std::int32_t> label;
    void add(const Vector3d& p, std::int32_t of = 0) {
        test::add(cloud, p.x(), p.y(), p.z());
        label.push_back(of);
    }
};

double between(test::Random& random, double low, double high) {
    return low + (high - low) * random.uniform();
}

geometry::Region level_region(double height) {
    geometry::Region out;
    out.model.origin = {0, 0, height};
    out.model.coefficients = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    out.residual_m = 0.004;
    return out;
}

// The region's own model lies a little inside, and a tenth of its points belongs to the wall.
TEST(Patches, LieWhereMostPointsAre) {
    test::Random random(3);
    Sampled s;
    for (int n = 0; n < 3000; ++n)
        s.add({between(random, 0, 0.3), between(random, 0, 0.2), 0.5 + 0.001 * random.normal()});
    for (int n = 0; n < 300; ++n)
        s.add({0.3, between(random, 0, 0.2), 0.5 + between(random, 0, 0.05)});
    ThreadPool threads(2);
    const std::vector<geometry::Region> regions{level_region(0.496)};
    const SurfacePatch patch = fit_patches({s.cloud, as_is}, regions, s.label, threads)[0];
    EXPECT_NEAR(patch.distance({0.1, 0.1, 0.5}), 0, 1.5e-4);
    EXPECT_GT(patch.distance({0.1, 0.1, 0.51}), 0.0099) << "it still faces up";
    EXPECT_NEAR(patch.noise_m, 0.001, 2e-4);
    EXPECT_LT(patch.offset_m, 0.001);
    EXPECT_TRUE(patch.flat());
}

// The order of the points is nothing to go by.
TEST(Patches, AreTheSameInAnyOrder) {
    test::Random random(5);
    Sampled there, back;
    std::vector<Vector3d> points;
    for (int n = 0; n < 9000; ++n)
        points.push_back(
            {between(random, 0, 0.3), between(random, 0, 0.2), 0.002 * random.normal()});
    for (const auto& p : points) there.add(p);
    for (auto p = points.rbegin(); p != points.rend(); ++p) back.add(*p);
    ThreadPool threads(2);
    const std::vector<geometry::Region> regions{level_region(0.001)};
    const SurfacePatch a = fit_patches({there.cloud, as_is}, regions, there.label, threads)[0],
                       b = fit_patches({back.cloud, as_is}, regions, back.label, threads)[0];
    EXPECT_EQ(a.c, b.c);
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.noise_m, b.noise_m);
}

TEST(Patches, OfATubeHaveItsRadius) {
    Sampled s;
    std::vector<Vector3d> points, normals;
    for (int n = 0; n < 4000; ++n) {
        const double turn = 0.7548777 * n, along = 0.5698403 * n;
        const double angle = 2 * std::numbers::pi * (turn - std::floor(turn));
        const Vector3d out(std::cos(angle), std::sin(angle), 0);
        points.push_back(0.05 * out + Vector3d(1, 2, 0.2 * (along - std::floor(along))));
        normals.push_back(out);
        s.add(points.back());
    }
    // As from surfels that lie 1 mm inside.
    std::vector<Vector3d> inside;
    for (std::size_t n = 0; n < points.size(); ++n)
        inside.push_back(points[n] - 0.001 * normals[n]);
    geometry::Region region;
    region.model = geometry::fit_quadric(inside, normals, 0.005);
    region.residual_m = 0.001;
    ThreadPool threads(2);
    const SurfacePatch patch =
        fit_patches({s.cloud, as_is}, std::vector{region}, s.label, threads)[0];
    for (std::size_t n = 0; n < points.size(); n += 97) {
        const Vec3 p{points[n].x(), points[n].y(), points[n].z()};
        EXPECT_NEAR(patch.distance(p), 0, 3e-5);
        const Vec3 g = patch.gradient(p);
        EXPECT_GT(g[0] * normals[n].x() + g[1] * normals[n].y(), 0.9) << "out of the tube";
    }
}

// Points of one row leave a quadric open.
TEST(Patches, OfARowArePlanes) {
    Sampled s;
    for (int n = 0; n < 200; ++n) s.add({1.4, 0.03125 * n, 0.0625});
    geometry::Region region = level_region(0.0625);
    region.model.degree = 2;
    ThreadPool threads(2);
    for (const double open : {0.0, 1e16}) {
        region.model.coefficients[5] = open;
        const SurfacePatch patch =
            fit_patches({s.cloud, as_is}, std::vector{region}, s.label, threads)[0];
        for (std::size_t n = 4; n < patch.c.size(); ++n) EXPECT_LT(std::abs(patch.c[n]), 1);
        EXPECT_NEAR(patch.distance({1.4, 2, 0.0625}), 0, 1e-5);
    }
}

// Surfels along an edge make a narrow face of their own, whose points are those of both sides.
TEST(Patches, OfAnEdgeAreItsSides) {
    Sampled s;
    std::vector<std::int32_t> patch_of_point;
    const auto add = [&](const Vector3d& p) {
        const bool edge = p.x() > 0.28 && p.z() > -0.02;
        s.add(p);
        patch_of_point.push_back(edge ? 2 : p.z() < 0 ? 1 : 0);
    };
    for (double y = 0; y < 0.2; y += 0.004) {
        for (double x = 0; x < 0.3; x += 0.004) add({x, y, 0});
        for (double z = -0.004; z > -0.2; z -= 0.004) add({0.3, y, z});
    }
    SurfacePatch top, side, edge;
    top.c = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    side.origin = {0.3, 0, 0};
    side.c = {0, 1, 0, 0, 0, 0, 0, 0, 0, 0};
    edge.origin = {0.295, 0, -0.005};
    edge.c = {0, std::sqrt(0.5), 0, std::sqrt(0.5), 0, 0, 0, 0, 0, 0};
    top.noise_m = side.noise_m = edge.noise_m = 1e-3;
    ThreadPool threads(2);
    PointLabels labels{s.label, patch_of_point};
    drop_explained({s.cloud, as_is}, std::vector{top, side, edge}, 0.04, labels, threads);
    for (std::size_t n = 0; n < s.label.size(); ++n) {
        const bool on_top = std::abs(s.cloud.z[n])<1e-6, on_side = s.cloud.x[n]> 0.2999F;
        if (on_top && on_side) continue;
        ASSERT_EQ(labels.patch[n], on_top ? 0 : 1) << s.cloud.x[n] << " " << s.cloud.z[n];
    }
}

// The rim of a box's wall, 8 mm wide: points that the regions of both sides hold between them.
TEST(NarrowFaces, AreWhatPointsOffTheirPatchesLieIn) {
    constexpr double thick = 0.008, high = 0.1;
    const auto patch = [](const Vector3d& at, const Vector3d& out) {
        SurfacePatch p;
        p.origin = {at.x(), at.y(), at.z()};
        p.c = {0, out.x(), out.y(), out.z(), 0, 0, 0, 0, 0, 0};
        p.noise_m = 2e-4;
        return p;
    };
    test::Random random(9);
    Sampled s;
    std::vector<std::int32_t> on;
    for (int n = 0; n < 2000; ++n) {
        s.add({1e-4 * random.normal(), between(random, 0, 0.2), between(random, 0, high)});
        on.push_back(0);
        s.add({thick + 1e-4 * random.normal(), between(random, 0, 0.2), between(random, 0, high)});
        on.push_back(1);
    }
    const std::size_t sides = s.label.size();
    for (int n = 0; n < 200; ++n) {
        s.add({between(random, 0.001, thick - 0.001), between(random, 0, 0.2),
               high + 1e-4 * random.normal()});
        on.push_back(n % 2);
    }
    // One of the far side among those of the near one.
    on[1] = 0;
    std::vector<SurfacePatch> patches{patch({0, 0, 0}, {-1, 0, 0}),
                                      patch({thick, 0, 0}, {1, 0, 0})};
    ThreadPool threads(2);
    PointLabels labels{s.label, on};
    add_narrow_faces({s.cloud, as_is}, 0.02, patches, labels, threads);
    ASSERT_EQ(patches.size(), 3u);
    EXPECT_NEAR(patches[2].distance({0.004, 0.1, high}), 0, 1e-4);
    EXPECT_NEAR(patches[2].gradient({0.004, 0.1, high})[2], 1, 1e-2) << "the wall is below";
    EXPECT_EQ(labels.patch[1], 1);
    for (std::size_t n = 0; n < on.size(); ++n)
        ASSERT_EQ(labels.patch[n], n >= sides ? 2 : static_cast<std::int32_t>(n % 2));
}

// Points in the middle of a board are no face: the board goes on to both sides of them.
TEST(NarrowFaces, HaveTheirPrimitiveBehindThem) {
    test::Random random(11);
    Sampled s;
    std::vector<std::int32_t> on;
    std::vector<SurfacePatch> patches(2);
    for (int side = 0; side < 2; ++side) {
        patches[side].c = {side * -0.01, 0, 0, side ? 1.0 : -1.0};
        patches[side].noise_m = 1e-4;
    }
    for (int n = 0; n < 3000; ++n) {
        s.add({between(random, 0, 0.2), between(random, 0, 0.2), n % 2 * 0.01});
        on.push_back(n % 2);
    }
    for (int n = 0; n < 100; ++n) {
        s.add({between(random, 0, 0.2), between(random, 0, 0.2), 0.005});
        on.push_back(0);
    }
    ThreadPool threads(2);
    PointLabels labels{s.label, on};
    add_narrow_faces({s.cloud, as_is}, 0.02, patches, labels, threads);
    EXPECT_EQ(patches.size(), 2u);
}

TEST(SeenCells, HoldCountAndMeanOfEachPatch) {
    Sampled s;
    s.add({0.011, 0.012, -0.001});
    s.add({0.013, 0.012, -0.003});
    s.add({0.011, 0.012, 0.001});
    s.add({0.5, 0.5, 0.5});
    ThreadPool threads(2);
    const SeenCells cells =
        seen_cells({s.cloud, as_is}, {{4, 4, 4, -1}, {7, 7, 7, 7}}, 0.02, threads);
    ASSERT_EQ(cells.size(), 2u);
    EXPECT_EQ(cells.k[0], -1);
    EXPECT_EQ(cells.count[0], 2);
    EXPECT_NEAR(cells.x[0], 0.012, 1e-6);
    EXPECT_EQ(cells.primitive[1], 4);
    EXPECT_EQ(cells.patch[1], 7);
}

}  // namespace
}  // namespace topple::solids
