// SPDX-License-Identifier: MIT
#include "geometry/surfel_discs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "clouds.h"
#include "device/devices.h"
#include "geometry/surfel_graph.h"
#include "random.h"

namespace topple::geometry {
namespace {

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
