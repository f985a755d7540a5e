// SPDX-License-Identifier: MIT
#include "lab/solids/analytic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lab/solids/scene.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

// Voxel counts tend to the volume: with voxels of h over a body of size L the error falls at least
// with the share of surface voxels, about 3 h / L, and mostly cancels.
TEST(Analytic, VoxelsHaveTheVolumeAndTheCentre) {
    const auto turn = rotation({0.48, 0.64, 0.6}, 0.9);
    for (const Body body :
         {Body::box, Body::cylinder, Body::cone, Body::hemisphere, Body::sphere}) {
        for (const bool turned : {false, true}) {
            AnalyticSolid solid{
                body, {0.3, 0.2, 0.5}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.103, -0.207, 0.051}};
            if (turned) solid.turn = turn;
            SolidCells cells;
            cells.voxel_m = 0.005;
            append(cells, solid, 3);
            const double h3 = std::pow(cells.voxel_m, 3);
            EXPECT_NEAR(static_cast<double>(cells.size()) * h3, solid.volume(),
                        0.01 * solid.volume());
            Vec3 sum{};
            for (std::size_t n = 0; n < cells.size(); ++n) {
                sum[0] += (cells.i[n] + 0.5) * cells.voxel_m;
                sum[1] += (cells.j[n] + 0.5) * cells.voxel_m;
                sum[2] += (cells.k[n] + 0.5) * cells.voxel_m;
            }
            const Vec3 center = solid.center();
            for (std::size_t k = 0; k < 3; ++k) {
                EXPECT_NEAR(sum[k] / static_cast<double>(cells.size()), center[k],
                            cells.voxel_m / 2);
            }
        }
    }
}

TEST(Analytic, ClosedForms) {
    using std::numbers::pi;
    EXPECT_DOUBLE_EQ((AnalyticSolid{Body::cone, {0.2, 0, 0.3}}).volume(), pi * 0.001);
    EXPECT_DOUBLE_EQ((AnalyticSolid{Body::cone, {0.2, 0, 0.3}}).center()[2], 0.075);
    EXPECT_DOUBLE_EQ((AnalyticSolid{Body::hemisphere, {0.2}}).center()[2], 0.0375);
    EXPECT_DOUBLE_EQ((AnalyticSolid{Body::hemisphere, {0.2}}).volume() * 2,
                     (AnalyticSolid{Body::sphere, {0.2}}).volume());
}

TEST(Analytic, CellsAreSortedUniqueAndSurfacesAreSeen) {
    SolidCells cells;
    cells.voxel_m = 0.01;
    append(cells, {Body::box, {0.1, 0.1, 0.1}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.05, 0.05, 0}}, 0);
    ASSERT_EQ(cells.size(), 1000u);
    append(cells, {Body::box, {0.1, 0.1, 0.1}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.10, 0.05, 0}}, 1);
    ASSERT_EQ(cells.size(), 1500u);
    std::size_t surface = 0, second = 0;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (n > 0) {
            EXPECT_LT(std::tuple(cells.i[n - 1], cells.j[n - 1], cells.k[n - 1]),
                      std::tuple(cells.i[n], cells.j[n], cells.k[n]));
        }
        second += cells.primitive[n] == 1;
        surface += cells.basis[n] == Basis::surface;
    }
    EXPECT_EQ(second, 500u);
    EXPECT_EQ(surface, 488u + 244u);  // the first's 1000 - 512; half of the other's
}

TEST(Analytic, RefusesVoxelsThatAreTooSmall) {
    SolidCells cells;
    EXPECT_THROW(append(cells, {}, 0), Error);
    cells.voxel_m = 1e-4;
    EXPECT_THROW(append(cells, {}, 0), Error);
}

}  // namespace
}  // namespace topple::scenes
