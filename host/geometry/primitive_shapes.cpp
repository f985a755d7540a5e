// SPDX-License-Identifier: MIT
#include "geometry/primitive_shapes.h"

#include <algorithm>
#include <cmath>

#include "core/ranked.h"

namespace topple::geometry {
namespace {

constexpr double along = 0.8;  // cosine of 37 degrees

// The values at 1 % and 99 % of the order.
std::array<double, 2> ends(std::vector<float>& values) {
    const double low = double{quantile(values, 0.01)}, high = double{quantile(values, 0.99)};
    return {low, high};
}

void find_bounds(const SurfaceSamples& s, std::size_t first, std::size_t last,
                 std::vector<float>& values, Eigen::Vector3d& low, Eigen::Vector3d& high) {
    Eigen::Index axis = 0;
    for (const std::vector<float>* from : {&s.x, &s.y, &s.z}) {
        values.assign(from->begin() + static_cast<std::ptrdiff_t>(first),
                      from->begin() + static_cast<std::ptrdiff_t>(last));
        const auto [least, most] = ends(values);
        low[axis] = least;
        high[axis] = most;
        ++axis;
    }
}

void find_colour(const SurfaceSamples& s, PrimitiveShape& p) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0, known = 0;
    for (std::size_t n = p.first; n < p.last; ++n) {
        const Eigen::Vector3d colour(s.lab_l[n], s.lab_a[n], s.lab_b[n]);
        if (!colour.allFinite()) continue;
        sum += colour;
        squares += colour.squaredNorm();
        known += 1;
    }
    if (known == 0) return;
    p.colour = sum / known;
    p.colour_spread = std::sqrt(std::max(0.0, squares / known - p.colour.squaredNorm()));
}

}  // namespace

Eigen::Vector3d PrimitiveShape::face() const {
    return normal.norm() > 0.5 ? Eigen::Vector3d(normal.normalized())
                               : Eigen::Vector3d(axes.col(0));
}

PrimitiveShapes primitive_shapes(const SurfaceSamples& s, std::size_t primitives) {
    PrimitiveShapes out;
    out.of.resize(primitives);
    std::vector<float> values;
    find_bounds(s, 0, s.size(), values, out.low, out.high);
    const double cell = s.spacing_m * s.spacing_m;
    out.area_m2 = cell * static_cast<double>(s.size());
    for (std::size_t first = 0; first < s.size();) {
        std::size_t last = first;
        while (last < s.size() && s.primitive[last] == s.primitive[first]) ++last;
        if (s.primitive[first] >= 0) {
            PrimitiveShape& p = out.of[s.primitive[first]];
            p.first = first;
            p.last = last;
        }
        first = last;
    }
    for (PrimitiveShape& p : out.of) {
        if (p.samples() == 0) continue;
        const double count = static_cast<double>(p.samples());
        p.area_m2 = cell * count;
        Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
        for (std::size_t n = p.first; n < p.last; ++n) {
            p.center += Eigen::Vector3d(s.x[n], s.y[n], s.z[n]);
            const Eigen::Vector3d normal(s.nx[n], s.ny[n], s.nz[n]);
            p.normal += normal;
            p.up_share += normal[2] > along;
            p.down_share += normal[2] < -along;
            p.side_share += std::abs(normal[2]) < 1 - along;
        }
        p.center /= count;
        p.normal /= count;
        p.up_share /= count;
        p.down_share /= count;
        p.side_share /= count;
        for (std::size_t n = p.first; n < p.last; ++n) {
            const Eigen::Vector3d d = Eigen::Vector3d(s.x[n], s.y[n], s.z[n]) - p.center;
            products += d * d.transpose();
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(products / count);
        p.spread = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
        p.axes = solver.eigenvectors();
        find_bounds(s, p.first, p.last, values, p.low, p.high);
        if (s.coloured()) find_colour(s, p);
    }
    return out;
}

}  // namespace topple::geometry
