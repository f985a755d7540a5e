// SPDX-License-Identifier: MIT
#include "lab/solids/part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/vectors.h"

namespace topple::scenes {
namespace {

using solids::Frustum;

// A cone, a cylinder or a lying cylinder about its axis.
Frustum frustum(const Part& part) {
    switch (part.shape) {
        case Shape::lying_cylinder:
            return {part.size[1] / 2, part.size[1] / 2, part.size[0] / 2};
        case Shape::cone:
            return {part.size[0] / 2, part.size[0] / 2 * part.top_ratio, part.size[2] / 2};
        default:
            return {part.size[0] / 2, part.size[0] / 2, part.size[2] / 2};
    }
}

// Room to part axes; a lying cylinder's axis becomes the third.
Vec3 turn(const Part& part, const Part::Heading& h, const Vec3& v) {
    const Vec3 q{h.cosine * v[0] + h.sine * v[1], -h.sine * v[0] + h.cosine * v[1], v[2]};
    if (part.shape == Shape::lying_cylinder) return {q[1], q[2], q[0]};
    return {q[0], h.lean_cosine * q[1] + h.lean_sine * q[2],
            -h.lean_sine * q[1] + h.lean_cosine * q[2]};
}

// The part's x, y and z in the room's frame.
std::array<Vec3, 3> own_axes(const Part::Heading& h) {
    return {Vec3{h.cosine, h.sine, 0},
            Vec3{-h.sine * h.lean_cosine, h.cosine * h.lean_cosine, h.lean_sine},
            Vec3{h.sine * h.lean_sine, -h.cosine * h.lean_sine, h.lean_cosine}};
}

bool is_boxy(Shape shape) {
    return shape == Shape::box || shape == Shape::rounded_box || shape == Shape::lying_cylinder;
}

// How far the part reaches along each axis of the room from its center: least and greatest.
Bounds reach(const Part& part) {
    if (part.shape == Shape::sphere) {
        const double r = part.size[0] / 2;
        return {Vec3{-r, -r, -r}, Vec3{r, r, r}};
    }
    const auto axes = own_axes(part.heading());
    Bounds out{};
    for (std::size_t k = 0; k < 3; ++k) {
        if (is_boxy(part.shape)) {
            const double r = part.rounding;
            double half = r;
            for (std::size_t a = 0; a < 3; ++a)
                half += std::abs(axes[a][k]) * (part.size[a] - 2 * r) / 2;
            out[0][k] = -half;
            out[1][k] = half;
            continue;
        }
        const double along = axes[2][k], across = std::sqrt(std::max(0.0, 1 - along * along));
        for (const auto& [r, z] : part.outline()) {
            out[0][k] = std::min(out[0][k], along * z - across * r);
            out[1][k] = std::max(out[1][k], along * z + across * r);
        }
    }
    return out;
}

}  // namespace

const char* to_string(Shape shape) {
    constexpr std::array names{"box", "rounded", "cyl", "lying", "sph", "cone", "revolved"};
    return names[static_cast<std::size_t>(shape)];
}

double Part::volume() const {
    using std::numbers::pi;
    switch (shape) {
        case Shape::box:
            return size[0] * size[1] * size[2];
        case Shape::rounded_box:
            return solids::rounded_box_volume(size, rounding);
        case Shape::cylinder:
            return pi / 4 * size[0] * size[0] * size[2];
        case Shape::lying_cylinder:
            return pi / 4 * size[1] * size[1] * size[0];
        case Shape::sphere:
            return pi / 6 * size[0] * size[0] * size[0];
        case Shape::cone:
            return pi / 12 * size[0] * size[0] * size[2] * (1 + top_ratio + top_ratio * top_ratio);
        case Shape::revolved:
            return solids::revolved_volume(profile);
    }
    return 0;
}

Vec3 Part::center_of_mass() const {
    double above = 0;  // along its own z
    if (shape == Shape::cone) {
        const double q = top_ratio;
        above = size[2] / 4 * (1 + 2 * q + 3 * q * q) / (1 + q + q * q) - size[2] / 2;
    } else if (shape == Shape::revolved) {
        above = solids::revolved_center_z(profile);
    }
    return along(center, above, own_axes(heading())[2]);
}

Part::Heading Part::heading() const {
    return {std::cos(yaw), std::sin(yaw), std::cos(lean), std::sin(lean)};
}

double Part::distance(const Vec3& p) const {
    return distance(p, heading());
}

double Part::distance(const Vec3& p, const Heading& heading) const {
    const Vec3 q = turn(*this, heading, minus(p, center));
    switch (shape) {
        case Shape::box:
            return solids::box_distance(q, size);
        case Shape::rounded_box:
            return solids::rounded_box_distance(q, size, rounding);
        case Shape::sphere:
            return length(q) - size[0] / 2;
        case Shape::revolved:
            return solids::revolved_distance(q, profile);
        default:
            return solids::frustum_distance(q, frustum(*this));
    }
}

Vec3 Part::normal(const Vec3& p) const {
    constexpr double h = 1e-6;
    const Heading way = heading();
    Vec3 n{};
    for (std::size_t k = 0; k < 3; ++k) {
        Vec3 a = p, b = p;
        a[k] -= h;
        b[k] += h;
        n[k] = distance(b, way) - distance(a, way);
    }
    n = unit(n);
    return n == Vec3{} ? Vec3{0, 0, 1} : n;
}

double Part::hit(const Vec3& origin, const Vec3& direction, const Heading& heading) const {
    const Vec3 o = turn(*this, heading, minus(origin, center)), d = turn(*this, heading, direction);
    switch (shape) {
        case Shape::box:
            return solids::box_hit(o, d, size);
        case Shape::rounded_box:
            return solids::rounded_box_hit(o, d, size, rounding);
        case Shape::sphere:
            return solids::sphere_hit(o, d, size[0] / 2);
        case Shape::revolved:
            return solids::revolved_hit(o, d, profile);
        default:
            return solids::frustum_hit(o, d, frustum(*this));
    }
}

std::array<Vec3, 3> Part::axes() const {
    const auto [x, y, z] = own_axes(heading());
    if (shape == Shape::lying_cylinder) return {y, z, x};
    return {x, y, z};
}

solids::Profile Part::outline() const {
    if (shape == Shape::revolved) return profile;
    const auto [low, high, half] = frustum(*this);
    return {{low, -half}, {high, half}};
}

double Part::bounding_radius() const {
    if (shape == Shape::sphere) return size[0] / 2;
    if (shape == Shape::box || shape == Shape::rounded_box) return length(size) / 2;
    double most = 0;
    for (const auto& [r, z] : outline()) most = std::max(most, std::hypot(r, z));
    return most;
}

Bounds Part::bounds() const {
    auto box = reach(*this);
    for (Vec3& corner : box) corner = along(corner, 1, center);
    return box;
}

Part Part::hull() const {
    Part convex = *this;
    if (shape == Shape::revolved) convex.profile = solids::convex_profile(profile);
    return convex;
}

namespace {

// max of two convex functions, by subgradient steps; both gradients have length 1. Steps shrink
// geometrically, and the best value seen is kept.
double least_common_distance(const Part& a, const Part& b, double tolerance) {
    Vec3 p = along(a.center, 0.5, minus(b.center, a.center));
    const double scale = a.bounding_radius() + b.bounding_radius();
    double best = std::numeric_limits<double>::infinity();
    for (double step = scale; step > tolerance / 4; step *= 0.97) {
        const double da = a.distance(p), db = b.distance(p);
        best = std::min(best, std::max(da, db));
        const Vec3 na = a.normal(p), nb = b.normal(p);
        // Near the tie both matter: alternating between them walks along the crease.
        const double back = std::min(step, std::max(std::abs(da - db), step / 2));
        p = along(p, -back, da > db ? na : nb);
    }
    return best;
}

}  // namespace

double gap(const Part& a, const Part& b, double tolerance) {
    return 2 * least_common_distance(a.hull(), b.hull(), tolerance);
}

}  // namespace topple::scenes
