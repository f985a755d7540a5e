// SPDX-License-Identifier: MIT
#include "lab/solids/solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple::scenes::solids {
namespace {

using std::numbers::pi;

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

double nearer(double best, double t) {
    return t > 1e-9 && t < best ? t : best;
}

using Point = std::array<double, 2>;  // r, z

double to_segment(const Point& p, const Point& a, const Point& b) {
    const double r = b[0] - a[0], z = b[1] - a[1], square = r * r + z * z;
    const double along =
        square > 0 ? std::clamp(((p[0] - a[0]) * r + (p[1] - a[1]) * z) / square, 0.0, 1.0) : 0.0;
    return std::hypot(p[0] - a[0] - along * r, p[1] - a[1] - along * z);
}

// What the edge from a to b sweeps out: a disc or ring where it is level, else a frustum's side.
double edge_hit(const Vec3& o, const Vec3& d, const Point& a, const Point& b, double best) {
    if (a[1] == b[1]) {
        if (d[2] == 0) return best;
        const double t = (a[1] - o[2]) / d[2], r = std::hypot(o[0] + t * d[0], o[1] + t * d[1]);
        const bool within = r >= std::min(a[0], b[0]) && r <= std::max(a[0], b[0]);
        return within ? nearer(best, t) : best;
    }
    const Point &low = a[1] < b[1] ? a : b, &high = a[1] < b[1] ? b : a;
    const Vec3 from{o[0], o[1], o[2] - (low[1] + high[1]) / 2};
    return frustum_side_hit(from, d, {low[0], high[0], (high[1] - low[1]) / 2}, best);
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
    const Vec3 c = core_of(size, r);
    return c[0] * c[1] * c[2] + 2 * r * (c[0] * c[1] + c[1] * c[2] + c[2] * c[0]) +
           pi * r * r * (c[0] + c[1] + c[2]) + 4 * pi / 3 * r * r * r;
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

double sphere_hit(const Vec3& o, const Vec3& d, double radius) {
    const double b = o[0] * d[0] + o[1] * d[1] + o[2] * d[2];
    const double c = o[0] * o[0] + o[1] * o[1] + o[2] * o[2];
    const double disc = b * b - c + radius * radius;
    if (disc < 0) return infinity;
    const double root = std::sqrt(disc);
    return nearer(nearer(infinity, -b - root), -b + root);
}

// r(z) = mean + slope * z, so that x^2 + y^2 = r(z)^2 is a quadratic in t.
double frustum_side_hit(const Vec3& o, const Vec3& d, const Frustum& f, double best) {
    const double h = f.half_height, slope = (f.high - f.low) / (2 * h), mean = (f.low + f.high) / 2;
    const double ro = mean + slope * o[2], rd = slope * d[2];
    const double a = d[0] * d[0] + d[1] * d[1] - rd * rd;
    const double b = o[0] * d[0] + o[1] * d[1] - ro * rd;
    const double c = o[0] * o[0] + o[1] * o[1] - ro * ro;
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
    return best;
}

double frustum_hit(const Vec3& o, const Vec3& d, const Frustum& f) {
    const double h = f.half_height;
    double best = frustum_side_hit(o, d, f, infinity);
    if (d[2] != 0) {
        for (const double z : {-h, h}) {
            const double t = (z - o[2]) / d[2], x = o[0] + t * d[0], y = o[1] + t * d[1];
            const double radius = z < 0 ? f.low : f.high;
            if (x * x + y * y <= radius * radius) best = nearer(best, t);
        }
    }
    return best;
}

double revolved_distance(const Vec3& q, const Profile& profile) {
    const Point p{std::hypot(q[0], q[1]), q[2]};
    double best = infinity;
    bool inside = false;  // even-odd rule along the ray of growing r
    for (std::size_t n = 1; n < profile.size(); ++n) {
        const Point &a = profile[n - 1], &b = profile[n];
        best = std::min(best, to_segment(p, a, b));
        if ((a[1] > p[1]) == (b[1] > p[1])) continue;
        if (p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) inside = !inside;
    }
    return inside ? -best : best;
}

double revolved_hit(const Vec3& o, const Vec3& d, const Profile& profile) {
    double best = infinity;
    for (std::size_t n = 1; n < profile.size(); ++n)
        best = edge_hit(o, d, profile[n - 1], profile[n], best);
    return best;
}

// Edges that run up add the frustum below them to the axis, those that run down take it away.
double revolved_volume(const Profile& profile) {
    double sum = 0;
    for (std::size_t n = 1; n < profile.size(); ++n) {
        const auto [r0, z0] = profile[n - 1];
        const auto [r1, z1] = profile[n];
        sum += pi / 3 * (z1 - z0) * (r0 * r0 + r0 * r1 + r1 * r1);
    }
    return sum;
}

double revolved_center_z(const Profile& profile) {
    double moment = 0;
    for (std::size_t n = 1; n < profile.size(); ++n) {
        const auto [r0, z0] = profile[n - 1];
        const auto [r1, z1] = profile[n];
        const double area = (r0 * r0 + r0 * r1 + r1 * r1) / 3;
        const double slope = r0 * r0 / 12 + r0 * r1 / 6 + r1 * r1 / 4;
        moment += pi * (z1 - z0) * (z0 * area + (z1 - z0) * slope);
    }
    return moment / revolved_volume(profile);
}

Profile convex_profile(const Profile& profile) {
    Profile sorted = profile;
    std::sort(sorted.begin(), sorted.end(), [](const Point& a, const Point& b) {
        return a[1] != b[1] ? a[1] < b[1] : a[0] < b[0];
    });
    Profile hull{{0, sorted.front()[1]}};
    sorted.push_back({0, sorted.back()[1]});
    for (const Point& p : sorted) {
        while (hull.size() > 1) {
            const Point &a = hull[hull.size() - 2], &b = hull.back();
            const double turn = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            if (turn > 0) break;
            hull.pop_back();
        }
        hull.push_back(p);
    }
    return hull;
}

}  // namespace topple::scenes::solids
