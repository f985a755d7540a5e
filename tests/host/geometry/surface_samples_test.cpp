// SPDX-License-Identifier: MIT
#include "geometry/surface_samples.h"

#include <random>

#include "clouds.h"
#include "device/devices.h"
#include "geometry/surface_gaps.h"
#include "geometry/surfel_discs.h"
#include "geometry/surfel_graph.h"
#include "testing.h"
#include "topple/kernel_testing/random.h"

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

constexpr double pitch = 0.05, step = 0.01;

// Points with their face and primitive, of which each cell of surfels keeps one.
struct Labelled {
    struct Point {
        double x, y, z;
        std::int32_t face, primitive;
    };
    std::map<std::array<std::int32_t, 3>, Point> points;
    void add(double x, double y, double z, std::int32_t on, std::int32_t of) {
        const auto cell = [](double v) {
            return static_cast<std::int32_t>(std::floor(v / (0.65 * pitch)));
        };
        points.try_emplace({cell(x), cell(y), cell(z)}, Point{x, y, z, on, of});
    }
    GapPoints close(double step_m = step) const {
        Surfels s;
        std::vector<std::int32_t> face, primitive;
        s.cell_m = 0.65 * pitch;
        for (const auto& [cell, p] : points) {
            s.cx.push_back(cell[0]);
            s.cy.push_back(cell[1]);
            s.cz.push_back(cell[2]);
            test::add(s, p.x, p.y, p.z);
            face.push_back(p.face);
            primitive.push_back(p.primitive);
        }
        ThreadPool threads(2);
        connect_surfels(s, 4 * pitch, threads);
        return close_gaps(s, face, primitive, step_m, threads);
    }
};

// A square of a metre.
Labelled square(double spacing, double high_from_x = 2) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> off(-0.2, 0.2);
    Labelled out;
    const int across = static_cast<int>(std::lround(1 / spacing));
    for (int i = 0; i < across; ++i) {
        for (int j = 0; j < across; ++j) {
            const double x = (i + 0.5 + off(random)) * spacing;
            out.add(x, (j + 0.5 + off(random)) * spacing, 0.3, 0, x > high_from_x ? 1 : 0);
        }
    }
    return out;
}

TEST(SurfaceGaps, AreClosedWithinWhatWasSeen) {
    Labelled scan = square(pitch);
    const GapPoints gaps = scan.close();
    std::set<std::pair<int, int>> covered;
    for (std::size_t n = 0; n < gaps.size(); ++n) {
        EXPECT_NEAR(gaps.z[n], 0.3, 1e-6);
        EXPECT_EQ(gaps.face[n], 0);
        EXPECT_GT(std::min(gaps.x[n], gaps.y[n]), 0);
        EXPECT_LT(std::max(gaps.x[n], gaps.y[n]), 1);
        covered.insert(
            {static_cast<int>(gaps.x[n] / (2 * step)), static_cast<int>(gaps.y[n] / (2 * step))});
    }
    int missing = 0;
    for (int i = 5; i < 45; ++i)
        for (int j = 5; j < 45; ++j) missing += !covered.contains({i, j});
    EXPECT_EQ(missing, 0) << "voxels of two steps without a point";
}

// Where each neighbour lies within two steps.
TEST(SurfaceGaps, OfDensePointsAreNone) {
    EXPECT_EQ(square(pitch).close(2 * pitch).size(), 0u);
}

TEST(SurfaceGaps, BetweenPrimitivesStayOpen) {
    const GapPoints gaps = square(pitch, 0.5).close();
    for (std::size_t n = 0; n < gaps.size(); ++n)
        EXPECT_EQ(gaps.primitive[n], gaps.x[n] > 0.5F ? 1 : 0) << gaps.x[n];
}

TEST(SurfaceGaps, AcrossAnEdgeBelongToNoFace) {
    Labelled scan = square(pitch);
    for (int j = 0; j < 20; ++j)
        for (int k = 1; k < 10; ++k) scan.add(1, (j + 0.5) * pitch, 0.3 - k * pitch, 1, 0);
    bool any = false;
    const GapPoints gaps = scan.close();
    for (std::size_t n = 0; n < gaps.size(); ++n) {
        if (gaps.face[n] < 0) any = true;
        const double off = gaps.face[n] == 0 ? gaps.z[n] - 0.3 : gaps.x[n] - 1;
        if (gaps.face[n] >= 0) {
            EXPECT_NEAR(off, 0, 1e-6);
        }
    }
    EXPECT_TRUE(any);
}

class Discs : public ::testing::Test {
  protected:
    void add(double x, double y, double z) { test::add(cloud, x, y, z); }
    // Points at random over a square of this side from a corner.
    void scatter(double x, double y, double side, double per_m2) {
        for (int n = 0; n < static_cast<int>(side * side * per_m2); ++n)
            add(x + side * random.uniform(), y + side * random.uniform(), 0);
    }
    // Share of a square of the plane that lies in no disc.
    static double open_share(const Surfels& s, const std::vector<float>& radii, double low,
                             double high) {
        int open = 0, all = 0;
        for (double x = low; x < high; x += 0.006) {
            for (double y = low; y < high; y += 0.006) {
                bool covered = false;
                for (std::size_t i = 0; i < s.size() && !covered; ++i)
                    covered = std::hypot(s.x[i] - x, s.y[i] - y) <= radii[i];
                open += !covered;
                ++all;
            }
        }
        return static_cast<double>(open) / all;
    }

    std::unique_ptr<device::Device> device = device::open_native();
    ThreadPool pool{2};
    test::Random random{11};
    PointCloud cloud;
};

// Where points are four times as sparse as elsewhere, discs of one size leave gaps.
TEST_F(Discs, CoverWhatIsScannedUnevenly) {
    scatter(0, 0, 1, 8000);
    scatter(2, 2, 1, 2000);
    const Surfels s = make_surfels(*device, cloud, {0.016, 0.011, 0.05}, {}, {});
    const std::vector<float> alike = covering_radii(s, 0, pool),
                             covering = covering_radii(s, 0.08, pool);
    EXPECT_GT(open_share(s, alike, 2.1, 2.9), 0.05);
    EXPECT_LT(open_share(s, covering, 2.1, 2.9), 0.002);
    EXPECT_LT(open_share(s, covering, 0.1, 0.9), 0.002);
    for (std::size_t i = 0; i < s.size(); ++i) {
        EXPECT_GE(covering[i], alike[i]);
        EXPECT_LE(covering[i], 0.08f);
    }
}

// At the edge to another face a disc reaches no farther than that face does.
TEST_F(Discs, EndWhereAnotherFaceBegins) {
    for (int i = 0; i < 50; ++i) {
        for (int j = 0; j < 50; ++j) {
            add(0.02 * i, 0.02 * j, 0);
            if (j > 0) add(0.02 * i, 0, -0.02 * j);
        }
    }
    const Surfels s = make_surfels(*device, cloud, {0.02, 0.02}, {}, {});
    const std::vector<float> radii = covering_radii(s, 0.5, pool);
    int edge = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (s.x[i] < 0.2 || s.x[i] > 0.8 || s.y[i] > 0.03 || s.z[i] < -0.03) continue;
        EXPECT_LT(radii[i], 0.03f);
        ++edge;
    }
    EXPECT_GT(edge, 30);
}

// The rim of a board is narrower than its discs; what they reach beyond the board is cut off, but
// for what overlaps the board's own discs.
TEST_F(Discs, AreCutWhereTheFacesOfNeighboursCross) {
    constexpr double pitch = 0.02, thick = 0.04, side = 0.3;
    std::map<std::array<int, 3>, std::array<Vec3, 2>> surfels;  // by cell: place and normal
    const auto put = [&](const Vec3& at, const Vec3& normal) {
        const auto cell = [](double v) { return static_cast<int>(std::floor(v / pitch)); };
        surfels[{cell(at[0]), cell(at[1]), cell(at[2])}] = {at, normal};
    };
    for (double y = pitch / 2; y < side; y += pitch) {
        for (double x = pitch / 2; x < side; x += pitch) {
            put({x, y, 0}, {0, 0, -1});
            put({x, y, thick}, {0, 0, 1});
        }
        for (const double z : {0.01, 0.03}) put({side, y, z}, {1, 0, 0});
    }
    Surfels s;
    s.cell_m = pitch;
    s.area_m2 = pitch * pitch;
    for (const auto& [cell, surfel] : surfels) {
        s.cx.push_back(cell[0]);
        s.cy.push_back(cell[1]);
        s.cz.push_back(cell[2]);
        const auto [at, normal] = surfel;
        test::add(s, at);
        test::add_normal(s, normal);
    }
    connect_surfels(s, 2 * pitch, pool);
    const std::vector<float> radii(s.size(), 0.025F);
    const std::vector<DiscCuts> cuts = cuts_at_edges(s, radii, pool);
    ASSERT_EQ(cuts.size(), s.size());
    const auto keeps = [&](std::size_t i, const Vec3& p) {
        return std::ranges::all_of(cuts[i], [&](const DiscCut& cut) {
            return cut.normal[0] * p[0] + cut.normal[1] * p[1] + cut.normal[2] * p[2] >= cut.least;
        });
    };
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 at{s.x[i], s.y[i], s.z[i]};
        EXPECT_TRUE(keeps(i, at)) << "a surfel is cut from itself";
        if (s.nx[i] > 0) {  // of the rim: up to the board's faces and little farther
            EXPECT_TRUE(keeps(i, {at[0], at[1], -0.003}) &&
                        keeps(i, {at[0], at[1], thick + 0.003}));
            EXPECT_FALSE(keeps(i, {at[0], at[1], at[2] > thick / 2 ? thick + 0.005 : -0.005}));
            EXPECT_TRUE(keeps(i, {at[0], at[1] + 0.025, at[2]}));
        } else if (at[0] > side - pitch) {
            EXPECT_FALSE(keeps(i, {side + 0.005, at[1], at[2]}));
        } else if (at[0] < side - 2.5 * pitch) {
            EXPECT_EQ(cuts[i][0].normal, (std::array<float, 3>{})) << "parallel faces cut nothing";
        }
    }
}

TEST_F(Discs, OfNothingOrOnePointAreWhatSurfelsStandFor) {
    EXPECT_TRUE(covering_radii({}, 1, pool).empty());
    EXPECT_TRUE(cuts_at_edges({}, {}, pool).empty());
    add(1, 2, 3);
    const Surfels s = make_surfels(*device, cloud, {0.02, 0.02}, {}, {});
    EXPECT_FLOAT_EQ(covering_radii(s, 1, pool).at(0), 0.018f);
}

}  // namespace
}  // namespace topple::geometry
