// SPDX-License-Identifier: MIT
#include "geometry/algebraic_model.h"

#include <gtest/gtest.h>

#include <vector>

namespace topple::geometry {
namespace {

using Eigen::Vector3d;

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

}  // namespace
}  // namespace topple::geometry
