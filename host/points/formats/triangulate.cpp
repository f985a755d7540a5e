// SPDX-License-Identifier: MIT
#include "points/formats/triangulate.h"

#include <cmath>
#include <numeric>

namespace topple::io {
namespace {

// Cutting ears takes time with the square of the corners, at best.
constexpr std::size_t most_corners = 1000;

using Point = std::array<double, 2>;

double cross(const Point& a, const Point& b, const Point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// The polygon without the axis that it faces most, so that it turns to the left (Newell's normal).
std::vector<Point> flattened(const std::vector<Vec3>& polygon) {
    Vec3 normal{};
    for (std::size_t n = 0; n < polygon.size(); ++n) {
        const Vec3 &a = polygon[n], &b = polygon[(n + 1) % polygon.size()];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            normal[k] += (a[i] - b[i]) * (a[j] + b[j]);
        }
    }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) {
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    }
    std::vector<Point> out;
    for (const Vec3& p : polygon) {
        const double u = p[(axis + 1) % 3], v = p[(axis + 2) % 3];
        // Newell's sum of (a - b)(a + b) over (i, j) is twice the area, seen from the normal.
        out.push_back(normal[axis] < 0 ? Point{v, u} : Point{u, v});
    }
    return out;
}

bool is_ear(const std::vector<Point>& at, const std::vector<std::size_t>& left, std::size_t n) {
    const std::size_t size = left.size();
    const Point &a = at[left[(n + size - 1) % size]], &b = at[left[n]],
                &c = at[left[(n + 1) % size]];
    if (!(cross(a, b, c) > 0)) return false;
    for (std::size_t m = 0; m < size; ++m) {
        if (m == n || m == (n + 1) % size || m == (n + size - 1) % size) continue;
        const Point& p = at[left[m]];
        if (p == a || p == b || p == c) continue;
        if (cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0) return false;
    }
    return true;
}

}  // namespace

std::vector<std::array<std::size_t, 3>> triangulate(const std::vector<Vec3>& polygon) {
    std::vector<std::array<std::size_t, 3>> out;
    if (polygon.size() < 3) return out;
    std::vector<std::size_t> left(polygon.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    if (polygon.size() > 3 && polygon.size() <= most_corners) {
        const std::vector<Point> at = flattened(polygon);
        for (std::size_t n = 0, misses = 0; left.size() > 3 && misses < left.size();) {
            const std::size_t size = left.size();
            n %= size;
            if (!is_ear(at, left, n)) {
                ++n;
                ++misses;
                continue;
            }
            out.push_back({left[(n + size - 1) % size], left[n], left[(n + 1) % size]});
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(n));
            misses = 0;
        }
    }
    for (std::size_t n = 2; n < left.size(); ++n) out.push_back({left[0], left[n - 1], left[n]});
    return out;
}

}  // namespace topple::io
