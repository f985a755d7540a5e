// SPDX-License-Identifier: MIT
#include "graph/borders.h"

#include "core/thread_pool.h"
#include "graph/outline.h"
#include "host/geometry/sampled_faces.h"
#include "testing.h"

namespace topple::graph {
namespace {

ThreadPool& threads() {
    static ThreadPool pool(2);
    return pool;
}

using Eigen::Vector3d;
using test::SampledFaces;

// Two plates of 40 cm, side by side along x, the second `step_m` higher.
SampledFaces two_plates(double step_m, double apart_m = 0) {
    SampledFaces faces(0.025);
    faces.face(0, {0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0});
    faces.face(1, {0.4 + apart_m, 0, step_m}, {0.4, 0, 0}, {0, 0.4, 0});
    return faces;
}

// Of the lattices only the two rows next to the border are within 6 cm of the other plate's, at
// one and at two spacings from its first row.
TEST(Borders, OfFlushPlatesAreInClosedForm) {
    const auto borders = find_borders(two_plates(0).samples, threads());
    ASSERT_EQ(borders.size(), 1u);
    const Border& b = borders[0];
    EXPECT_EQ(b.a, 0);
    EXPECT_EQ(b.b, 1);
    EXPECT_EQ(b.near_a, 32u);
    EXPECT_EQ(b.near_b, 32u);
    EXPECT_NEAR(b.gap_least, 0.025, 1e-6);
    EXPECT_NEAR(b.gap_20, 0.025, 1e-6);
    EXPECT_NEAR(b.gap_50, 0.05, 1e-6);
    EXPECT_NEAR(b.convexity, 0, 1e-6);
    EXPECT_EQ(b.convex_share, 0);
    EXPECT_EQ(b.concave_share, 0);
    EXPECT_NEAR(b.parallel, 1, 1e-6);
    EXPECT_EQ(b.flush_share, 1);
    EXPECT_NEAR(b.offset, 0, 1e-6);
    EXPECT_NEAR((b.direction - Vector3d(1, 0, 0)).norm(), 0, 1e-5);
    EXPECT_NEAR((b.center - Vector3d(0.4, 0.2, 0)).norm(), 0, 1e-5);
    EXPECT_NEAR(b.spread[0], 0, 1e-5);
    EXPECT_NEAR(b.spread[1], 0.0125 / std::sqrt(2), 1e-5);
    EXPECT_NEAR(b.spread[2], 0.025 * std::sqrt((16 * 16 - 1) / 12.0), 1e-5);
    EXPECT_NEAR(b.low, 0, 1e-6);
    EXPECT_NEAR(b.high, 0, 1e-6);
    EXPECT_TRUE(std::isnan(b.colour));
}

TEST(Borders, AStepIsNotFlush) {
    const Border b = find_borders(two_plates(0.02).samples, threads()).at(0);
    EXPECT_EQ(b.flush_share, 0);
    EXPECT_NEAR(b.parallel, 1, 1e-6);
    EXPECT_NEAR(b.offset, 0.02, 1e-6);
    EXPECT_NEAR(b.gap_least, std::hypot(0.025, 0.02), 1e-6);
    EXPECT_GT(b.direction[2], 0.3) << "up from a to b";
}

TEST(Borders, AreWithinTheReachOfNoise) {
    EXPECT_DOUBLE_EQ(near_m(0.01), 0.06);
    EXPECT_DOUBLE_EQ(near_m(0.1), 0.22);
    EXPECT_NEAR(find_borders(two_plates(0, 0.03).samples, threads()).at(0).gap_least, 0.055, 1e-6);
    EXPECT_TRUE(find_borders(two_plates(0, 0.04).samples, threads()).empty());
    // Samples of no primitive border on nothing.
    SampledFaces loose = two_plates(0);
    for (std::int32_t& p : loose.samples.primitive) p = p == 1 ? -1 : p;
    EXPECT_TRUE(find_borders(loose.samples, threads()).empty());
    EXPECT_TRUE(find_borders({}, threads()).empty());
}

// A box's top and side bend away from each other, a floor and a wall towards each other.
TEST(Borders, TellOuterFromInnerEdges) {
    SampledFaces box(0.02), corner(0.02);
    box.face(0, {-0.4, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0});  // top, up to x = 0
    box.face(1, {0, 0, -0.4}, {0, 0.4, 0}, {0, 0, 0.4});  // side, towards +x
    corner.face(0, {0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0});  // floor
    corner.face(1, {0, 0, 0}, {0, 0.4, 0}, {0, 0, 0.4});  // wall at x = 0
    const Border outer = find_borders(box.samples, threads()).at(0);
    EXPECT_EQ(outer.convex_share, 1);
    EXPECT_EQ(outer.concave_share, 0);
    EXPECT_GT(outer.convexity, 1);
    EXPECT_LE(outer.convexity, std::sqrt(2.0) + 1e-6);
    EXPECT_NEAR(outer.parallel, 0, 1e-6);
    EXPECT_EQ(outer.flush_share, 0);
    const Border inner = find_borders(corner.samples, threads()).at(0);
    EXPECT_EQ(inner.concave_share, 1);
    EXPECT_EQ(inner.convex_share, 0);
    EXPECT_NEAR(inner.convexity, -outer.convexity, 1e-5) << "the same with the sides turned";
}

TEST(Borders, ColoursAreComparedWhereBothAreKnown) {
    SampledFaces faces = two_plates(0);
    faces.paint(0, 50, 3, 0);
    EXPECT_TRUE(std::isnan(find_borders(faces.samples, threads()).at(0).colour));
    faces.paint(1, 50, 0, 4);
    EXPECT_NEAR(find_borders(faces.samples, threads()).at(0).colour, 5, 1e-5);
    // Half of them without: the other half counts.
    for (std::size_t n = 0; n < faces.samples.size(); ++n)
        if (faces.samples.y[n] > 0.2f) faces.samples.lab_l[n] = NAN;
    EXPECT_NEAR(find_borders(faces.samples, threads()).at(0).colour, 5, 1e-5);
}

// Three plates in a row: each has a border with the next, in order.
TEST(Borders, AreSortedByTheirPrimitives) {
    SampledFaces faces(0.02);
    for (const std::int32_t p : {2, 0, 1}) faces.face(p, {0.4 * p, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0});
    const auto borders = find_borders(faces.samples, threads());
    ASSERT_EQ(borders.size(), 2u);
    EXPECT_EQ(std::pair(borders[0].a, borders[0].b), std::pair(0, 1));
    EXPECT_EQ(std::pair(borders[1].a, borders[1].b), std::pair(1, 2));
    EXPECT_GT(borders[0].direction[0], 0.9);
}

TEST(Outline, HasTheErrorOfItsCornersAlone) {
    const std::vector<BorderPoint> points{
        {{0, 0}, 0.01}, {{1, 0}, 0.02}, {{1, 1}, 0.03}, {{0, 1}, 0.02}, {{0.5, 0.5}, 1}};
    const Outline out = outline_of(points);
    EXPECT_EQ(out.polygon.size(), 4u);
    EXPECT_NEAR(out.error_m, 0.02, 1e-12);
}

// Where a corner is known twice, the better one counts.
TEST(Outline, TakesTheBetterOfTwo) {
    std::vector<BorderPoint> points;
    add_points({{0, 0}, {1, 0}, {0, 1}}, 0.01, points);
    add_points({{0, 0}, {1, 0}, {0, 1}}, 0.001, points);
    EXPECT_NEAR(outline_of(points).error_m, 0.001, 1e-12);
    EXPECT_TRUE(outline_of({}).polygon.empty());
}

}  // namespace
}  // namespace topple::graph
