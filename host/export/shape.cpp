// SPDX-License-Identifier: MIT
#include "export/shape.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/vectors.h"
#include "physics/infinity.h"

namespace topple::exports {
namespace {

// A round solid's radius may be off by that share of itself, too: small things keep their form.
constexpr double radius_share = 0.05;

// The point from which all of them are equally far, as nearly as may be (Kåsa 1976: |p|² = 2 c.p +
// k is linear in c and k). Columns: coordinates, of any dimension.
Eigen::VectorXd middle_of(const Eigen::MatrixXd& points) {
    const Eigen::VectorXd mean = points.rowwise().mean();
    const Eigen::MatrixXd from_mean = points.colwise() - mean;
    Eigen::MatrixXd equations(points.cols(), points.rows() + 1);
    equations << 2 * from_mean.transpose(), Eigen::VectorXd::Ones(points.cols());
    const Eigen::VectorXd squared = from_mean.colwise().squaredNorm().transpose();
    return mean + equations.colPivHouseholderQr().solve(squared).head(points.rows());
}

// Radii about a middle: of the part's corners, which it is within, and of its faces.
struct Radii {
    double corners_m = 0, faces_m = physics::infinity;

    // Nothing where they differ by more than a round solid may.
    std::optional<double> middle_m() const {
        const double radius = (corners_m + faces_m) / 2;
        if (!(radius > 0)) return std::nullopt;
        const double off = (corners_m - faces_m) / 2;
        if (off > std::min(round_tolerance_m, radius_share * radius)) return std::nullopt;
        return radius;
    }
};

std::optional<Cylinder> cylinder_along(const ConvexPart& part, const Vec3& axis) {
    const auto frame = frame_around(axis);
    const Interval ends = extent_along(part, axis);
    Eigen::MatrixXd across(2, part.corner.size());
    for (std::size_t n = 0; n < part.corner.size(); ++n)
        across.col(static_cast<Eigen::Index>(n)) << dot(frame[0], part.corner[n]),
            dot(frame[1], part.corner[n]);
    const Eigen::VectorXd middle = middle_of(across);
    Cylinder out;
    out.axis = axis;
    out.half_m = (ends.high - ends.low) / 2;
    for (const auto& [direction, at] : {std::pair{axis, (ends.high + ends.low) / 2},
                                        {frame[0], middle[0]},
                                        {frame[1], middle[1]}})
        out.center = along(out.center, at, direction);
    Radii radii;
    for (Eigen::Index n = 0; n < across.cols(); ++n)
        radii.corners_m = std::max(radii.corners_m, (across.col(n) - middle).norm());
    // A face that leans is reached by the rim of one end; what lies across the axis is an end.
    constexpr double end_cosine = 1 - 1e-9;
    for (const HalfSpace& side : part.face) {
        const double cosine = std::min(std::abs(dot(side.normal, axis)), 1.0);
        const double beyond = side.offset_m - dot(side.normal, out.center) - out.half_m * cosine;
        if (cosine < end_cosine)
            radii.faces_m = std::min(radii.faces_m, beyond / std::sqrt(1 - cosine * cosine));
        else if (-beyond > box_tolerance_m)
            return std::nullopt;
    }
    const auto radius = radii.middle_m();
    if (!radius) return std::nullopt;
    out.radius_m = *radius;
    return out;
}

double area_of(const ConvexPart& part, std::size_t face) {
    const auto& outline = part.outline[face];
    Vec3 twice{};
    for (std::size_t n = 1; n + 1 < outline.size(); ++n) {
        const Vec3 a = minus(part.corner[outline[n]], part.corner[outline[0]]);
        const Vec3 b = minus(part.corner[outline[n + 1]], part.corner[outline[0]]);
        twice = along(twice, 1, cross(a, b));
    }
    return std::sqrt(dot(twice, twice)) / 2;
}

std::optional<Cylinder> as_cylinder(const ConvexPart& part) {
    // The larger end; sides of a prism have four corners.
    constexpr std::size_t least_corners = 6;
    std::optional<std::size_t> largest;
    for (std::size_t n = 0; n < part.outline.size(); ++n) {
        if (part.outline[n].size() < least_corners) continue;
        if (!largest || area_of(part, n) > area_of(part, *largest)) largest = n;
    }
    if (!largest) return std::nullopt;
    Vec3 axis = part.face[*largest].normal;
    if (axis[2] < 0) axis = opposite(axis);
    return cylinder_along(part, axis);
}

std::optional<Sphere> as_sphere(const ConvexPart& part) {
    Eigen::MatrixXd corners(3, part.corner.size());
    for (std::size_t n = 0; n < part.corner.size(); ++n)
        for (std::size_t a = 0; a < 3; ++a)
            corners(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(n)) = part.corner[n][a];
    const Eigen::VectorXd middle = middle_of(corners);
    const Vec3 center{middle[0], middle[1], middle[2]};
    Radii radii;
    for (const Vec3& c : part.corner) {
        const Vec3 from = minus(c, center);
        radii.corners_m = std::max(radii.corners_m, std::sqrt(dot(from, from)));
    }
    for (const HalfSpace& side : part.face)
        radii.faces_m = std::min(radii.faces_m, side.offset_m - dot(side.normal, center));
    const auto radius = radii.middle_m();
    if (!radius) return std::nullopt;
    return Sphere{center, *radius};
}

// A box with its axes renumbered: the third is the most upright, the first lies along x most.
Box turned_least(const Box& box) {
    std::array<std::size_t, 3> order{0, 1, 2};
    const auto put_last = [&](std::size_t count, std::size_t coordinate) {
        const auto most = std::max_element(
            order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
            [&](std::size_t a, std::size_t b) {
                return std::abs(box.axis[a][coordinate]) < std::abs(box.axis[b][coordinate]);
            });
        std::iter_swap(most, order.begin() + static_cast<std::ptrdiff_t>(count - 1));
    };
    put_last(3, 2);
    put_last(2, 0);
    std::swap(order[0], order[1]);
    Box out = box;
    const auto forward = [&](std::size_t a, std::size_t coordinate) {
        const Vec3& v = box.axis[a];
        return v[coordinate] < 0 ? opposite(v) : v;
    };
    out.axis[0] = forward(order[0], 0);
    out.axis[2] = forward(order[2], 2);
    out.axis[1] = cross(out.axis[2], out.axis[0]);
    for (std::size_t a = 0; a < 3; ++a) out.half_m[a] = box.half_m[order[a]];
    return out;
}

}  // namespace

std::array<Vec3, 3> frame_around(const Vec3& axis) {
    // Square to it and to the axis of coordinates that it is farthest from.
    std::size_t least = 0;
    for (std::size_t a = 1; a < 3; ++a)
        if (std::abs(axis[a]) < std::abs(axis[least])) least = a;
    Vec3 e{};
    e[least] = 1;
    const Vec3 second = unit(cross(axis, e));
    return {cross(second, axis), second, axis};
}

Shape shape_of(const ConvexPart& part) {
    if (const auto box = as_box(part, box_tolerance_m)) return turned_least(*box);
    if (const auto cylinder = as_cylinder(part)) return *cylinder;
    if (const auto sphere = as_sphere(part)) return *sphere;
    return {};
}

}  // namespace topple::exports
