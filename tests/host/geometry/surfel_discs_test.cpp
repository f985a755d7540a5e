// SPDX-License-Identifier: MIT
#include "geometry/surfel_discs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "device/devices.h"
#include "geometry_random.h"

namespace topple::geometry {
namespace {

class Discs : public ::testing::Test {
  protected:
    void add(double x, double y, double z) {
        cloud.x.push_back(static_cast<float>(x));
        cloud.y.push_back(static_cast<float>(y));
        cloud.z.push_back(static_cast<float>(z));
    }
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

TEST_F(Discs, OfNothingOrOnePointAreWhatSurfelsStandFor) {
    EXPECT_TRUE(covering_radii({}, 1, pool).empty());
    add(1, 2, 3);
    const Surfels s = make_surfels(*device, cloud, {0.02, 0.02}, {}, {});
    EXPECT_FLOAT_EQ(covering_radii(s, 1, pool).at(0), 0.018f);
}

}  // namespace
}  // namespace topple::geometry
