// SPDX-License-Identifier: MIT
#include "geometry/face_surroundings.h"

#include <gtest/gtest.h>

#include "geometry/primitive_shapes.h"
#include "host/geometry/sampled_faces.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;

// A cupboard, 0.5 m deep and 1.6 m high, at a wall of 2.5 m.
enum Part : std::int32_t { wall, front, rest, parts };

SurfaceSamples cupboard_at_a_wall(double spacing_m) {
    test::SampledFaces faces(spacing_m);
    const Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    faces.face(wall, {0, 0, 0}, 3.4 * y, 2.5 * z);
    faces.face(front, {0.5, 1, 0}, 0.9 * y, 1.6 * z);
    faces.face(rest, {0.5, 0, 0}, 3 * x, 3.4 * y);
    faces.face(rest, {0, 1, 1.6}, 0.5 * x, 0.9 * y);
    faces.face(rest, {0, 1, 0}, 0.5 * x, 1.6 * z);
    faces.face(rest, {0, 1.9, 0}, 1.6 * z, 0.5 * x);
    return faces.samples;
}

class About : public testing::TestWithParam<double> {
  protected:
    FaceSurroundings of(Part part, double low_m, double high_m) const {
        const PrimitiveShapes shapes = primitive_shapes(samples_, parts);
        return face_surroundings(samples_, shapes.of[static_cast<std::size_t>(part)], 0, {1, 0, 0},
                                 low_m, high_m);
    }
    SurfaceSamples samples_ = cupboard_at_a_wall(GetParam());
};

TEST_P(About, ACupboardIsItsTopItsSidesAndTheWallAboveIt) {
    const FaceSurroundings about = of(front, 1, 1.9);
    EXPECT_NEAR(about.top_behind, 0.5 / 0.8, 0.15);
    EXPECT_NEAR(about.ends_behind, 2 * 0.5 / 0.8, 0.3);
    EXPECT_NEAR(about.wall_over, 0.78 / 0.8, 0.15);
    EXPECT_NEAR(about.floor_before, 1.38 / 1.5, 0.1);
    EXPECT_EQ(about.floor_behind, 0);
}

TEST_P(About, AWallIsFloorBeforeItAlone) {
    const FaceSurroundings about = of(wall, 0, 3.4);
    EXPECT_EQ(about.top_behind, 0);
    EXPECT_EQ(about.ends_behind, 0);
    EXPECT_EQ(about.wall_over, 0);
    EXPECT_EQ(about.floor_behind, 0);
    EXPECT_NEAR(about.floor_before, 1.0 / 1.5, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Spacing, About, testing::Values(0.02, 0.05));

}  // namespace
}  // namespace topple::geometry
