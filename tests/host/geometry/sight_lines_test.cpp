// SPDX-License-Identifier: MIT
#include "geometry/sight_lines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/geometry/sampled_faces.h"

namespace topple::geometry {
namespace {

// A floor of 3 m and a wall at x = 3.
test::SampledFaces floor_and_wall(double spacing_m) {
    test::SampledFaces faces(spacing_m);
    faces.face(0, {0, 0, 0}, {3, 0, 0}, {0, 3, 0});
    faces.face(1, {3, 0, 0}, {0, 0, 2}, {0, 3, 0});
    return faces;
}

TEST(SightLines, MeetWhatIsInTheWayWithinACell) {
    const SightLines lines(floor_and_wall(0.02).samples);
    EXPECT_DOUBLE_EQ(lines.cell_m(), 0.08);
    const double start = 1.5 * lines.cell_m();
    EXPECT_NEAR(lines.met_m({1, 1.5, 1}, {1, 0, 0}, start, 4), 2, 0.1);
    EXPECT_NEAR(lines.met_m({1, 1.5, 1}, {0, 0, -1}, start, 4), 1, 0.1);
    const double slope = std::sqrt(0.5);
    EXPECT_NEAR(lines.met_m({1, 1.5, 1.5}, {slope, 0, -slope}, start, 4), 1.5 / slope, 0.15);
    EXPECT_TRUE(std::isinf(lines.met_m({1, 1.5, 1}, {0, 0, 1}, start, 4))) << "no ceiling";
    EXPECT_TRUE(std::isinf(lines.met_m({1, 1.5, 1}, {-1, 0, 0}, start, 4))) << "no wall there";
}

TEST(SightLines, BeginAndEndWhereTheyAreTold) {
    const SightLines lines(floor_and_wall(0.02).samples);
    EXPECT_TRUE(std::isinf(lines.met_m({1, 1.5, 1}, {1, 0, 0}, 0.12, 1.8))) << "too short";
    // From the floor upwards: itself is not met, nor, from the wall outwards, is that.
    EXPECT_TRUE(std::isinf(lines.met_m({1, 1.5, 0}, {0, 0, 1}, 0.12, 4)));
    EXPECT_TRUE(std::isinf(lines.met_m({3, 1.5, 1}, {1, 0, 0}, 0.12, 4)));
    EXPECT_EQ(lines.met_m({1, 1.5, 0.02}, {0, 0, 1}, 0, 4), 0) << "it is, without a start";
}

// Coarser cells where samples are sparse, so that a ray does not pass between them.
TEST(SightLines, DoNotPassBetweenSparseSamples) {
    const SightLines lines(floor_and_wall(0.2).samples);
    EXPECT_NEAR(lines.cell_m(), 0.3, 1e-9);
    for (double y = 0.3; y < 2.7; y += 0.05)
        EXPECT_NEAR(lines.met_m({1, y, 1}, {1, 0, 0}, 0.45, 4), 2, 0.4) << y;
}

TEST(SightLines, MeetNothingInAnEmptyScene) {
    const SightLines lines{SurfaceSamples()};
    EXPECT_TRUE(std::isinf(lines.met_m({0, 0, 0}, {1, 0, 0}, 0.1, 1)));
}

}  // namespace
}  // namespace topple::geometry
