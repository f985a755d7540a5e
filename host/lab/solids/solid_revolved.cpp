// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/solids/solids.h"

namespace topple::scenes::solids {
namespace {

using std::numbers::pi;
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
        return within && t > 1e-9 && t < best ? t : best;
    }
    const Point &low = a[1] < b[1] ? a : b, &high = a[1] < b[1] ? b : a;
    const Vec3 from{o[0], o[1], o[2] - (low[1] + high[1]) / 2};
    return frustum_side_hit(from, d, {low[0], high[0], (high[1] - low[1]) / 2}, best);
}

}  // namespace

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
