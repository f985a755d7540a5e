// SPDX-License-Identifier: MIT
#include "geometry/primitive_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/geometry/sampled_faces.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;
using test::SampledFaces;

// Standard deviation of n points a spacing apart.
double lattice_spread(int n, double spacing) {
    return spacing * std::sqrt((n * n - 1) / 12.0);
}

TEST(PrimitiveShapes, OfAPlateAreInClosedForm) {
    SampledFaces faces(0.02);
    faces.face(0, {1, 0, 0.5}, {0.8, 0, 0}, {0, 0.4, 0});
    const PrimitiveShapes shapes = primitive_shapes(faces.samples, 1);
    const PrimitiveShape& p = shapes.of.at(0);
    EXPECT_EQ(p.samples(), 800u);
    EXPECT_NEAR(p.area_m2, 0.32, 1e-6);
    EXPECT_NEAR((p.center - Vector3d(1.4, 0.2, 0.5)).norm(), 0, 1e-5);
    EXPECT_NEAR(p.spread[0], 0, 1e-5);
    EXPECT_NEAR(p.spread[1], lattice_spread(20, 0.02), 1e-5);
    EXPECT_NEAR(p.spread[2], lattice_spread(40, 0.02), 1e-5);
    EXPECT_NEAR(std::abs(p.axes.col(2)[0]), 1, 1e-5) << "longest along x";
    EXPECT_NEAR((p.normal - Vector3d(0, 0, 1)).norm(), 0, 1e-6);
    EXPECT_NEAR((p.face() - Vector3d(0, 0, 1)).norm(), 0, 1e-6);
    EXPECT_EQ(p.up_share, 1);
    EXPECT_EQ(p.down_share, 0);
    EXPECT_EQ(p.side_share, 0);
    EXPECT_NEAR((p.low - Vector3d(1.01, 0.01, 0.5)).norm(), 0, 0.02);
    EXPECT_NEAR((p.high - Vector3d(1.79, 0.39, 0.5)).norm(), 0, 0.02);
    EXPECT_TRUE(std::isnan(p.colour[0]));
    EXPECT_TRUE(std::isnan(p.colour_spread));
}

TEST(PrimitiveShapes, OfABoxCountItsFaces) {
    SampledFaces faces(0.02);
    faces.box(0, {0, 0, 0}, {0.4, 0.4, 0.4});
    const PrimitiveShape p = primitive_shapes(faces.samples, 1).of.at(0);
    EXPECT_NEAR(p.area_m2, 0.8, 1e-6);
    EXPECT_NEAR(p.up_share, 0.2, 1e-6);
    EXPECT_NEAR(p.side_share, 0.8, 1e-6);
    EXPECT_NEAR((p.normal - Vector3d(0, 0, 0.2)).norm(), 0, 1e-6) << "its sides cancel";
    EXPECT_NEAR(p.face().norm(), 1, 1e-6) << "of no mean normal: an axis";
}

// A sheet of which both sides were seen has no mean normal, but a thin axis.
TEST(PrimitiveShapes, ASheetSeenFromBothSidesFacesAlongItsThinAxis) {
    SampledFaces faces(0.02);
    faces.face(0, {0, 0, 0}, {0.6, 0, 0}, {0, 0, 0.4});
    faces.face(0, {0, 0, 0}, {0, 0, 0.4}, {0.6, 0, 0});
    const PrimitiveShape p = primitive_shapes(faces.samples, 1).of.at(0);
    EXPECT_NEAR(p.normal.norm(), 0, 1e-6);
    EXPECT_NEAR(std::abs(p.face()[1]), 1, 1e-6);
    EXPECT_EQ(p.side_share, 1);
}

TEST(PrimitiveShapes, KnowTheSceneAndWhoHasNoSamples) {
    SampledFaces faces(0.02);
    faces.face(-1, {0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0});
    faces.face(1, {0, 0, 1}, {0.4, 0, 0}, {0, 0.4, 0});
    const PrimitiveShapes shapes = primitive_shapes(faces.samples, 3);
    EXPECT_EQ(shapes.of.at(0).samples(), 0u);
    EXPECT_EQ(shapes.of.at(0).area_m2, 0);
    EXPECT_EQ(shapes.of.at(1).first, 400u);
    EXPECT_EQ(shapes.of.at(1).last, 800u);
    EXPECT_EQ(shapes.of.at(2).samples(), 0u);
    EXPECT_NEAR(shapes.area_m2, 0.32, 1e-6) << "with what is of no primitive";
    EXPECT_NEAR(shapes.low[2], 0, 1e-6);
    EXPECT_NEAR(shapes.high[2], 1, 1e-6);
    EXPECT_TRUE(primitive_shapes({}, 0).of.empty());
}

// The outermost hundredth at either side does not count: one stray point moves no bounds.
TEST(PrimitiveShapes, StraySamplesMoveNoBounds) {
    SampledFaces faces(0.02);
    faces.face(0, {0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0});
    faces.samples.z[7] = 30;
    const PrimitiveShapes shapes = primitive_shapes(faces.samples, 1);
    EXPECT_NEAR(shapes.high[2], 0, 1e-6);
    EXPECT_NEAR(shapes.of[0].high[2], 0, 1e-6);
}

TEST(PrimitiveShapes, ColoursHaveAMeanAndASpread) {
    SampledFaces faces(0.02);
    faces.face(0, {0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0});
    faces.face(1, {0, 0, 1}, {0.4, 0, 0}, {0, 0.4, 0});
    faces.paint(0, 40, 10, -10);
    for (std::size_t n = 0; n < 400; n += 2) faces.samples.lab_l[n] = 60;
    const PrimitiveShapes shapes = primitive_shapes(faces.samples, 2);
    EXPECT_NEAR((shapes.of[0].colour - Vector3d(50, 10, -10)).norm(), 0, 1e-6);
    EXPECT_NEAR(shapes.of[0].colour_spread, 10, 1e-6);
    EXPECT_TRUE(std::isnan(shapes.of[1].colour_spread));
}

}  // namespace
}  // namespace topple::geometry
