// SPDX-License-Identifier: MIT
#include "geometry/algebraic_model.h"

#include <algorithm>
#include <cmath>

namespace topple::geometry {

namespace {

// Ridge on the second-degree coefficients, relative to the data's weight: a term that the points do
// not determine (a short piece of a tube says nothing of its ends) stays zero, the lower degree.
constexpr double second_degree_ridge = 1e-3;

using Monomials = Eigen::Matrix<double, 10, 1>;

Monomials monomials(const Eigen::Vector3d& q) {
    Monomials m;
    m << 1, q.x(), q.y(), q.z(), q.x() * q.x(), q.y() * q.y(), q.z() * q.z(), q.x() * q.y(),
        q.x() * q.z(), q.y() * q.z();
    return m;
}

Vec3 as_vec3(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace

double AlgebraicModel::value(double x, double y, double z) const {
    const auto& c = coefficients;
    const double u = x - origin[0], v = y - origin[1], w = z - origin[2];
    const double linear = c[0] + c[1] * u + c[2] * v + c[3] * w;
    if (degree == 1) return linear;
    return linear + c[4] * u * u + c[5] * v * v + c[6] * w * w + c[7] * u * v + c[8] * u * w +
           c[9] * v * w;
}

Eigen::Vector3d gradient(const AlgebraicModel& model, const Eigen::Vector3d& p) {
    const auto& c = model.coefficients;
    const double u = p.x() - model.origin[0], v = p.y() - model.origin[1],
                 w = p.z() - model.origin[2];
    return {c[1] + 2 * c[4] * u + c[7] * v + c[8] * w, c[2] + 2 * c[5] * v + c[7] * u + c[9] * w,
            c[3] + 2 * c[6] * w + c[8] * u + c[9] * v};
}

void PlaneMoments::add(const Eigen::Vector3d& p, const Eigen::Vector3d& n) {
    if (count == 0) shift = p;
    const Eigen::Vector3d q = p - shift;
    ++count;
    sum += q;
    outer += q * q.transpose();
    normal_sum += n;
    normal_outer += n * n.transpose();
}

AlgebraicModel fit_plane(const PlaneMoments& moments, double offset_m) {
    AlgebraicModel model;
    model.degree = 1;
    if (moments.count == 0) return model;
    const double n = static_cast<double>(moments.count);
    const Eigen::Vector3d mean = moments.sum / n;
    const Eigen::Matrix3d spread = moments.outer - n * mean * mean.transpose();
    // Normal equations of sum f(p)^2 + (f(p + e n) - e)^2 + (f(p - e n) + e)^2 about the mean,
    // where the constant term drops out: (3 S + 2 e^2 N) a = 2 e^2 sum n.
    const double e2 = 2 * offset_m * offset_m;
    const Eigen::Matrix3d lhs = 3 * spread + e2 * moments.normal_outer +
                                1e-12 * (e2 * n + spread.trace()) * Eigen::Matrix3d::Identity();
    Eigen::Vector3d a = lhs.ldlt().solve(moments.normal_sum * e2);
    // Noise across the plane shortens a; its direction is what the layers determine.
    const double length = a.norm();
    if (!(length > 0) || !std::isfinite(length)) {
        a = moments.normal_sum.norm() > 0 ? moments.normal_sum.normalized()
                                          : Eigen::Vector3d(0, 0, 1);
    } else {
        a /= length;
    }
    model.origin = as_vec3(moments.shift + mean);
    model.coefficients = {0, a.x(), a.y(), a.z(), 0, 0, 0, 0, 0, 0};
    return model;
}

AlgebraicModel fit_quadric(std::span<const Eigen::Vector3d> points,
                           std::span<const Eigen::Vector3d> normals, double offset_m) {
    AlgebraicModel model;
    model.degree = 2;
    if (points.empty()) return model;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    double spread = 0;
    for (const auto& p : points) spread += (p - mean).squaredNorm();
    const double scale = std::max(std::sqrt(spread / static_cast<double>(points.size())), 1e-9);
    const double e = offset_m / scale;

    Eigen::Matrix<double, 10, 10> lhs = Eigen::Matrix<double, 10, 10>::Zero();
    Monomials rhs = Monomials::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector3d q = (points[i] - mean) / scale;
        for (int layer = -1; layer <= 1; ++layer) {
            const Monomials m = monomials(q + layer * e * normals[i]);
            lhs.selfadjointView<Eigen::Lower>().rankUpdate(m);
            rhs += layer * e * m;
        }
    }
    const double ridge = second_degree_ridge * static_cast<double>(points.size());
    for (int k = 4; k < 10; ++k) lhs(k, k) += ridge * e * e;
    for (int k = 0; k < 4; ++k) lhs(k, k) += 1e-9 * static_cast<double>(points.size());
    const Monomials c = lhs.selfadjointView<Eigen::Lower>().ldlt().solve(rhs);
    if (!c.allFinite()) return model;

    // Back to metres: f_metres(p) = scale * f((p - mean) / scale).
    model.origin = as_vec3(mean);
    model.coefficients[0] = c[0] * scale;
    for (int k = 1; k < 4; ++k) model.coefficients[k] = c[k];
    for (int k = 4; k < 10; ++k) model.coefficients[k] = c[k] / scale;
    return model;
}

double distance(const AlgebraicModel& model, const Eigen::Vector3d& p) {
    const double f = model.value(p.x(), p.y(), p.z());
    if (model.degree == 1) return f;
    // Far inside a tube or ball the gradient vanishes on the axis; the floor keeps the distance
    // finite.
    return f / std::max(gradient(model, p).norm(), 0.2);
}

}  // namespace topple::geometry
