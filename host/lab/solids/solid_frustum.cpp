// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "lab/solids/solids.h"

namespace topple::scenes::solids {
namespace {

double nearer(double best, double t) {
    return t > 1e-9 && t < best ? t : best;
}

}  // namespace

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

}  // namespace topple::scenes::solids
