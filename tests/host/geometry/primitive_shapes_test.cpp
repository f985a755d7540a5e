// SPDX-License-Identifier: MIT
#include "geometry/primitive_shapes.h"

#include <random>

#include "device/devices.h"
#include "geometry/algebraic_model.h"
#include "geometry/plane_fit.h"
#include "host/geometry/sampled_faces.h"
#include "testing.h"

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

TEST(AlgebraicModel, PlaneThroughExactPointsIsExact) {
    const Vector3d n = Vector3d(1, 2, 2) / 3.0, u = n.unitOrthogonal(), v = n.cross(u);
    PlaneMoments moments;
    for (int a = 0; a < 5; ++a)
        for (int b = 0; b < 5; ++b) moments.add(Vector3d(7, -3, 2) + 0.1 * a * u + 0.1 * b * v, n);
    const AlgebraicModel plane = fit_plane(moments, 0.02);
    EXPECT_EQ(plane.degree, 1);
    const Vector3d outside = Vector3d(7, -3, 2) + 0.3 * n;
    EXPECT_NEAR(distance(plane, outside), 0.3, 1e-9);
    EXPECT_NEAR(distance(plane, outside - 0.5 * n), -0.2, 1e-9);
}

TEST(AlgebraicModel, PlaneOfOnePointIsItsTangentPlane) {
    PlaneMoments moments;
    moments.add({1, 1, 1}, {0, 0, 1});
    const AlgebraicModel plane = fit_plane(moments, 0.02);
    EXPECT_NEAR(distance(plane, {5, 5, 1.25}), 0.25, 1e-9);
}

TEST(AlgebraicModel, NoiseAcrossThePlaneDoesNotTiltIt) {
    PlaneMoments moments;
    for (int a = 0; a < 40; ++a)
        for (int b = 0; b < 40; ++b)
            moments.add({0.01 * a, 0.01 * b, (a + b) % 2 ? 0.01 : -0.01}, {0, 0, 1});
    const AlgebraicModel plane = fit_plane(moments, 0.02);
    EXPECT_GT(gradient(plane, {0, 0, 0}).z(), 0.99999);
    EXPECT_NEAR(distance(plane, {0.2, 0.2, 0}), 0, 1e-4);
}

// f = (|p|^2 - r^2) / 2r has gradient 1 on the ball: at a distance d outside it is d + d^2 / 2r.
TEST(AlgebraicModel, QuadricOfABall) {
    const double r = 0.1;
    const Vector3d centre(3, 4, 5);
    std::vector<Vector3d> points, normals;
    for (int a = 1; a < 20; ++a)
        for (int b = 0; b < 40; ++b) {
            const double s = std::sin(a * EIGEN_PI / 20), t = b * EIGEN_PI / 20;
            normals.emplace_back(s * std::cos(t), s * std::sin(t), std::cos(a * EIGEN_PI / 20));
            points.push_back(centre + r * normals.back());
        }
    const AlgebraicModel ball = fit_quadric(points, normals, 0.01);
    EXPECT_EQ(ball.degree, 2);
    for (std::size_t i = 0; i < points.size(); i += 37) {
        EXPECT_NEAR(distance(ball, points[i]), 0, 0.002);
        EXPECT_NEAR(distance(ball, points[i] + 0.01 * normals[i]), 0.01, 0.003);
        EXPECT_LT(distance(ball, points[i] - 0.01 * normals[i]), -0.007);
        EXPECT_GT(gradient(ball, points[i]).normalized().dot(normals[i]), 0.999);
    }
    const Vector3d inside = centre;
    EXPECT_LT(ball.value(inside.x(), inside.y(), inside.z()), 0);
}

TEST(AlgebraicModel, QuadricOfFlatPointsStaysFlat) {
    std::vector<Vector3d> points, normals;
    for (int a = 0; a < 20; ++a)
        for (int b = 0; b < 20; ++b) {
            points.emplace_back(0.02 * a, 0.02 * b, 0.5);
            normals.emplace_back(0, 0, 1);
        }
    const AlgebraicModel model = fit_quadric(points, normals, 0.02);
    EXPECT_NEAR(distance(model, {0.2, 0.2, 0.55}), 0.05, 0.002);
    EXPECT_GT(gradient(model, {0.35, 0.05, 0.5}).normalized().z(), 0.9999);
}

TEST(AlgebraicModel, FitsOfNothingAreFinite) {
    EXPECT_EQ(fit_plane(PlaneMoments{}, 0.02).value(1, 2, 3), 0);
    EXPECT_EQ(fit_quadric({}, {}, 0.02).value(1, 2, 3), 0);
}

// The cells that points of a surface lie in, each with their mean.
CellGrid grid_of(const std::vector<std::array<double, 3>>& points) {
    std::map<std::array<std::int32_t, 3>, std::array<double, 4>> cells;
    for (const auto& p : points) {
        std::array<std::int32_t, 3> at{};
        for (std::size_t a = 0; a < 3; ++a) at[a] = static_cast<std::int32_t>(std::floor(p[a]));
        auto& sum = cells[at];
        for (std::size_t a = 0; a < 3; ++a) sum[a] += p[a] - at[a] - 0.5;
        sum[3] += 1;
    }
    CellGrid out;
    out.cell_m = 1;
    out.resize(cells.size());
    std::size_t n = 0;
    for (const auto& [at, sum] : cells) {
        out.x[n] = at[0], out.y[n] = at[1], out.z[n] = at[2];
        out.weight[n] = 1;
        for (std::size_t a = 0; a < 3; ++a) out.mean[a][n] = static_cast<float>(sum[a] / sum[3]);
        ++n;
    }
    return out;
}

// How far outside of a tube about z its cells' means are moved to, by planes or by their mean.
double off_tube(double radius, double noise, bool with_mean) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> turn(0, 2 * std::numbers::pi), along(-12, 12);
    std::normal_distribution<double> off(0, noise);
    std::vector<std::array<double, 3>> points;
    for (int n = 0; n < 40000; ++n) {
        const double a = turn(random), r = radius + off(random);
        points.push_back({r * std::cos(a) + 0.3, r * std::sin(a) + 0.1, along(random)});
    }
    const CellGrid grid = grid_of(points);
    const auto device = device::open_native();
    const PlaneQueries queries = queries_at_means(grid);
    PlaneFitter fitter(*device, grid, queries);
    const PlaneFit fit = fitter.fit({});
    const std::vector<float> offset = with_mean ? fitter.mean_offsets(fit) : fit.offset;
    double out = 0, count = 0;
    for (std::size_t q = 0; q < queries.cell.size(); ++q) {
        const std::size_t c = queries.cell[q];
        if (std::abs(grid.z[c]) > 7) continue;
        const double x = grid.x[c] + 0.5 + queries.at[0][q] + offset[q] * fit.normal[0][q] - 0.3,
                     y = grid.y[c] + 0.5 + queries.at[1][q] + offset[q] * fit.normal[1][q] - 0.1;
        out += std::hypot(x, y) - radius;
        ++count;
    }
    return out / count;
}

TEST(PlaneMean, DoesNotShrinkWhatIsRound) {
    for (const double radius : {6.0, 12.0, 24.0}) {
        const double plane = off_tube(radius, 0.05, false), mean = off_tube(radius, 0.05, true);
        EXPECT_LT(plane, -0.3 / radius) << "a plane alone does, radius " << radius;
        EXPECT_LT(std::abs(mean), 0.15 * std::abs(plane)) << radius;
    }
}

}  // namespace
}  // namespace topple::geometry
