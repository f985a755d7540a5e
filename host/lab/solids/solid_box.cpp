// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "lab/solids/solids.h"

namespace topple::scenes::solids {
namespace {

// Where a ray is inside of something convex; in > out: nowhere.
struct Interval {
    double in = infinity, out = -infinity;
    void join(const Interval& other) {
        if (other.in > other.out) return;
        in = std::min(in, other.in);
        out = std::max(out, other.out);
    }
    // The first end with t > 0.
    double hit() const {
        if (in > out) return infinity;
        return in > 1e-9 ? in : out > 1e-9 ? out : infinity;
    }
};

Interval in_box(const Vec3& o, const Vec3& d, const Vec3& half) {
    Interval all{-infinity, infinity};
    for (std::size_t k = 0; k < 3; ++k) {
        if (d[k] == 0) {
            if (std::abs(o[k]) > half[k]) return {};
            continue;
        }
        const double t0 = (-half[k] - o[k]) / d[k], t1 = (half[k] - o[k]) / d[k];
        all.in = std::max(all.in, std::min(t0, t1));
        all.out = std::min(all.out, std::max(t0, t1));
    }
    return all;
}

// A sphere about `center`, or, with `axis` 0 to 2, the endless cylinder through it along that axis.
Interval in_round(const Vec3& o, const Vec3& d, const Vec3& center, double radius,
                  std::size_t axis = 3) {
    double a = 0, b = 0, c = -radius * radius;
    for (std::size_t k = 0; k < 3; ++k) {
        if (k == axis) continue;
        const double from = o[k] - center[k];
        a += d[k] * d[k];
        b += d[k] * from;
        c += from * from;
    }
    if (a < 1e-18) return c <= 0 ? Interval{-infinity, infinity} : Interval{};
    const double root = b * b - a * c;
    if (root < 0) return {};
    return {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
}

Interval both(const Interval& a, const Interval& b) {
    return {std::max(a.in, b.in), std::min(a.out, b.out)};
}

Vec3 core_of(const Vec3& size, double rounding) {
    return {size[0] - 2 * rounding, size[1] - 2 * rounding, size[2] - 2 * rounding};
}

}  // namespace

double box_distance(const Vec3& q, const Vec3& size) {
    double outside = 0, inside = -infinity;
    for (std::size_t k = 0; k < 3; ++k) {
        const double d = std::abs(q[k]) - size[k] / 2;
        outside += d > 0 ? d * d : 0;
        inside = std::max(inside, d);
    }
    return std::sqrt(outside) + std::min(inside, 0.0);
}

double box_hit(const Vec3& o, const Vec3& d, const Vec3& size) {
    return in_box(o, d, {size[0] / 2, size[1] / 2, size[2] / 2}).hit();
}

double rounded_box_distance(const Vec3& q, const Vec3& size, double rounding) {
    return box_distance(q, core_of(size, rounding)) - rounding;
}

// The union of three boxes, twelve cylinders along the edges and eight spheres is convex, so that a
// ray is inside of it from the first entry to the last exit.
double rounded_box_hit(const Vec3& o, const Vec3& d, const Vec3& size, double rounding) {
    const Vec3 half{size[0] / 2, size[1] / 2, size[2] / 2};
    if (in_box(o, d, half).hit() == infinity) return infinity;
    const Vec3 core{half[0] - rounding, half[1] - rounding, half[2] - rounding};
    Interval all;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 slab = core;
        slab[axis] = half[axis];
        all.join(in_box(o, d, slab));
        Vec3 along{infinity, infinity, infinity};
        along[axis] = core[axis];
        const Interval length = in_box(o, d, along);
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const double su : {-1.0, 1.0}) {
            for (const double sv : {-1.0, 1.0}) {
                Vec3 center{};
                center[u] = su * core[u];
                center[v] = sv * core[v];
                all.join(both(length, in_round(o, d, center, rounding, axis)));
            }
        }
    }
    for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
            for (const double z : {-1.0, 1.0})
                all.join(in_round(o, d, {x * core[0], y * core[1], z * core[2]}, rounding));
        }
    }
    return all.hit();
}

double rounded_box_volume(const Vec3& size, double r) {
    using std::numbers::pi;
    const Vec3 c = core_of(size, r);
    return c[0] * c[1] * c[2] + 2 * r * (c[0] * c[1] + c[1] * c[2] + c[2] * c[0]) +
           pi * r * r * (c[0] + c[1] + c[2]) + 4 * pi / 3 * r * r * r;
}

}  // namespace topple::scenes::solids
