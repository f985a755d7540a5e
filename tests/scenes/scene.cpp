// SPDX-License-Identifier: MIT
#include "scenes/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace topple::scenes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Vec3 add(const Vec3& a, const Vec3& b, double scale) {
    return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}
double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// A solid of revolution about its z: radius `low` at the bottom, `high` at the top.
struct Frustum {
    double low, high, half_height;
};
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
    return part.shape == Shape::lying_cylinder ? Vec3{q[1], q[2], q[0]} : q;
}

double box_distance(const Vec3& q, const Vec3& size) {
    double outside = 0, inside = -infinity;
    for (int k = 0; k < 3; ++k) {
        const double d = std::abs(q[k]) - size[k] / 2;
        outside += d > 0 ? d * d : 0;
        inside = std::max(inside, d);
    }
    return std::sqrt(outside) + std::min(inside, 0.0);
}

// In the half plane (r >= 0, z): distance to a trapezium that is bounded by the axis, the two caps
// and the slanted side.
double frustum_distance(const Vec3& q, const Frustum& f) {
    const double r = std::hypot(q[0], q[1]), z = q[2], h = f.half_height;
    const double slant = std::hypot(2 * h, f.low - f.high);
    const double nr = 2 * h / slant, nz = (f.low - f.high) / slant;  // outward normal of the side
    const double side = (r - f.low) * nr + (z + h) * nz;
    const double cap = std::abs(z) - h;
    if (side <= 0 && cap <= 0) return std::max(side, cap);
    const double edge = z > 0 ? f.high : f.low;
    const double to_cap = std::hypot(std::max(r - edge, 0.0), cap);
    const double along =
        std::clamp(((r - f.low) * (f.high - f.low) + (z + h) * 2 * h) / (slant * slant), 0.0, 1.0);
    const double to_side =
        std::hypot(r - (f.low + along * (f.high - f.low)), z - (-h + along * 2 * h));
    return std::min(to_cap, to_side);
}

double nearer(double best, double t) {
    return t > 1e-9 && t < best ? t : best;
}

double box_hit(const Vec3& o, const Vec3& d, const Vec3& size) {
    double in = -infinity, out = infinity;
    for (int k = 0; k < 3; ++k) {
        const double h = size[k] / 2;
        if (d[k] == 0) {
            if (std::abs(o[k]) > h) return infinity;
            continue;
        }
        const double t0 = (-h - o[k]) / d[k], t1 = (h - o[k]) / d[k];
        in = std::max(in, std::min(t0, t1));
        out = std::min(out, std::max(t0, t1));
    }
    if (in > out) return infinity;
    return nearer(nearer(infinity, in), out);
}

double sphere_hit(const Vec3& o, const Vec3& d, double radius) {
    const double b = dot(o, d), disc = b * b - dot(o, o) + radius * radius;
    if (disc < 0) return infinity;
    const double root = std::sqrt(disc);
    return nearer(nearer(infinity, -b - root), -b + root);
}

// r(z) = mean + slope * z, so that x^2 + y^2 = r(z)^2 is a quadratic in t.
double frustum_hit(const Vec3& o, const Vec3& d, const Frustum& f) {
    const double h = f.half_height, slope = (f.high - f.low) / (2 * h), mean = (f.low + f.high) / 2;
    const double ro = mean + slope * o[2], rd = slope * d[2];
    const double a = d[0] * d[0] + d[1] * d[1] - rd * rd;
    const double b = o[0] * d[0] + o[1] * d[1] - ro * rd;
    const double c = o[0] * o[0] + o[1] * o[1] - ro * ro;
    double best = infinity;
    const auto side = [&](double t) {
        const double z = o[2] + t * d[2];
        if (std::abs(z) <= h && mean + slope * z >= 0) best = nearer(best, t);
    };
    if (std::abs(a) > 1e-14) {
        const double disc = b * b - a * c;
        if (disc >= 0) {
            side((-b - std::sqrt(disc)) / a);
            side((-b + std::sqrt(disc)) / a);
        }
    } else if (b != 0) {
        side(-c / (2 * b));
    }
    if (d[2] != 0) {
        for (const double z : {-h, h}) {
            const double t = (z - o[2]) / d[2], x = o[0] + t * d[0], y = o[1] + t * d[1];
            const double radius = z < 0 ? f.low : f.high;
            if (x * x + y * y <= radius * radius) best = nearer(best, t);
        }
    }
    return best;
}

}  // namespace

const char* to_string(Shape shape) {
    switch (shape) {
        case Shape::box:
            return "box";
        case Shape::cylinder:
            return "cyl";
        case Shape::lying_cylinder:
            return "lying";
        case Shape::sphere:
            return "sph";
        case Shape::cone:
            return "cone";
    }
    return "box";
}

double Part::volume() const {
    using std::numbers::pi;
    switch (shape) {
        case Shape::box:
            return size[0] * size[1] * size[2];
        case Shape::cylinder:
            return pi / 4 * size[0] * size[0] * size[2];
        case Shape::lying_cylinder:
            return pi / 4 * size[1] * size[1] * size[0];
        case Shape::sphere:
            return pi / 6 * size[0] * size[0] * size[0];
        case Shape::cone:
            return pi / 12 * size[0] * size[0] * size[2] * (1 + top_ratio + top_ratio * top_ratio);
    }
    return 0;
}

Vec3 Part::center_of_mass() const {
    if (shape != Shape::cone) return center;
    const double q = top_ratio, height = size[2];
    const double above = height / 4 * (1 + 2 * q + 3 * q * q) / (1 + q + q * q);
    return {center[0], center[1], bottom() + above};
}

Part::Heading Part::heading() const {
    return {std::cos(yaw), std::sin(yaw)};
}

double Part::distance(const Vec3& p) const {
    return distance(p, heading());
}

double Part::distance(const Vec3& p, const Heading& heading) const {
    const Vec3 q = turn(*this, heading, add(p, center, -1));
    if (shape == Shape::box) return box_distance(q, size);
    if (shape == Shape::sphere) return std::sqrt(dot(q, q)) - size[0] / 2;
    return frustum_distance(q, frustum(*this));
}

Vec3 Part::normal(const Vec3& p) const {
    constexpr double h = 1e-6;
    const Heading way = heading();
    Vec3 n{};
    for (int k = 0; k < 3; ++k) {
        Vec3 a = p, b = p;
        a[k] -= h;
        b[k] += h;
        n[k] = distance(b, way) - distance(a, way);
    }
    const double length = std::sqrt(dot(n, n));
    if (length == 0) return {0, 0, 1};
    return {n[0] / length, n[1] / length, n[2] / length};
}

double Part::hit(const Vec3& origin, const Vec3& direction, const Heading& heading) const {
    const Vec3 o = turn(*this, heading, add(origin, center, -1)),
               d = turn(*this, heading, direction);
    if (shape == Shape::box) return box_hit(o, d, size);
    if (shape == Shape::sphere) return sphere_hit(o, d, size[0] / 2);
    return frustum_hit(o, d, frustum(*this));
}

double Part::bounding_radius() const {
    if (shape == Shape::sphere) return size[0] / 2;
    if (shape == Shape::box) return std::sqrt(dot(size, size)) / 2;
    const Frustum f = frustum(*this);
    return std::hypot(std::max(f.low, f.high), f.half_height);
}

std::array<Vec3, 2> Part::bounds() const {
    const double c = std::abs(std::cos(yaw)), s = std::abs(std::sin(yaw));
    Vec3 half{size[0] / 2, size[1] / 2, size[2] / 2};
    if (shape == Shape::box || shape == Shape::lying_cylinder) {
        half = {c * size[0] / 2 + s * size[1] / 2, s * size[0] / 2 + c * size[1] / 2, size[2] / 2};
    } else if (shape == Shape::cone) {
        half[0] = half[1] = size[0] / 2 * std::max(1.0, top_ratio);
    }
    return {add(center, half, -1), add(center, half, 1)};
}

double gap(const Part& a, const Part& b, double tolerance) {
    // max of two convex functions, by subgradient steps; both gradients have length 1. Steps shrink
    // geometrically, and the best value seen is kept.
    Vec3 p = add(a.center, add(b.center, a.center, -1), 0.5);
    const double scale = a.bounding_radius() + b.bounding_radius();
    double best = infinity;
    for (double step = scale; step > tolerance / 4; step *= 0.97) {
        const double da = a.distance(p), db = b.distance(p);
        best = std::min(best, std::max(da, db));
        const Vec3 na = a.normal(p), nb = b.normal(p);
        // Near the tie both matter: alternating between them walks along the crease.
        p = add(p, da > db ? na : nb, -std::min(step, std::max(std::abs(da - db), step / 2)));
    }
    return 2 * best;
}

Vec3 World::to_input(const Vec3& p) const {
    return {tilt[0] * p[0] + tilt[1] * p[1] + tilt[2] * p[2],
            tilt[3] * p[0] + tilt[4] * p[1] + tilt[5] * p[2],
            tilt[6] * p[0] + tilt[7] * p[1] + tilt[8] * p[2]};
}

Vec3 World::to_room(const Vec3& p) const {
    return {tilt[0] * p[0] + tilt[3] * p[1] + tilt[6] * p[2],
            tilt[1] * p[0] + tilt[4] * p[1] + tilt[7] * p[2],
            tilt[2] * p[0] + tilt[5] * p[1] + tilt[8] * p[2]};
}

std::pair<double, std::int32_t> World::distance(const Vec3& p) const {
    std::pair<double, std::int32_t> best{infinity, -1};
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const double d = parts[k].distance(p);
        if (d < best.first) best = {d, static_cast<std::int32_t>(k)};
    }
    return best;
}

std::array<double, 9> rotation(const Vec3& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle), x = axis[0], y = axis[1], z = axis[2];
    return {c + x * x * (1 - c),     x * y * (1 - c) - z * s, x * z * (1 - c) + y * s,
            y * x * (1 - c) + z * s, c + y * y * (1 - c),     y * z * (1 - c) - x * s,
            z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)};
}

}  // namespace topple::scenes
