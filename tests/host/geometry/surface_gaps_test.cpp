// SPDX-License-Identifier: MIT
#include "geometry/surface_gaps.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "clouds.h"
#include "geometry/surfel_graph.h"

namespace topple::geometry {
namespace {

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

}  // namespace
}  // namespace topple::geometry
