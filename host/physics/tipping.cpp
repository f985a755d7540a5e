// SPDX-License-Identifier: MIT
#include "physics/tipping.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::physics {
namespace {

using Point = std::array<double, 2>;

double turn(const Point& o, const Point& a, const Point& b) {
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

Point nearest_on_segment(const Point& a, const Point& b, double x, double y) {
    const double ex = b[0] - a[0], ey = b[1] - a[1], length2 = ex * ex + ey * ey;
    if (!(length2 > 0)) return a;
    const double t = std::clamp(((x - a[0]) * ex + (y - a[1]) * ey) / length2, 0.0, 1.0);
    return {a[0] + t * ex, a[1] + t * ey};
}

}  // namespace

Footing footing(std::span<const Point> polygon, double x, double y) {
    Footing result;
    const std::size_t n = polygon.size();
    bool inside = n >= 3;
    double border = std::numeric_limits<double>::infinity();
    Point nearest{x, y};
    for (std::size_t e = 0; e < n; ++e) {
        const Point &a = polygon[e], &b = polygon[(e + 1) % n];
        const double ex = b[0] - a[0], ey = b[1] - a[1], length = std::sqrt(ex * ex + ey * ey);
        const Point p = nearest_on_segment(a, b, x, y);
        const double distance = std::sqrt((p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y));
        if (distance < border) {
            border = distance;
            nearest = p;
            result.nearest = {a, b};
        }
        if (!(length > 0)) continue;
        const double within = (ex * (y - a[1]) - ey * (x - a[0])) / length;
        inside = inside && within > 0;
        result.edges.push_back({within, {ey / length, -ex / length, 0}, {a, b}});
    }
    if (inside && result.edges.size() >= 3) {
        result.margin_m = border;
        return result;
    }
    result.edges.clear();
    result.margin_m = -border;
    if (border > 0 && std::isfinite(border)) {
        result.away = {(x - nearest[0]) / border, (y - nearest[1]) / border, 0};
    }
    return result;
}

double rise_over_edge_m(double height_m, double distance_m) {
    return std::hypot(height_m, distance_m) - height_m;
}

double edge_distance_m(double rise_m, double height_m) {
    return std::sqrt(rise_m * std::max(rise_m + 2 * height_m, 0.0));
}

std::vector<Point> convex_polygon(std::vector<Point> points) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    std::vector<Point> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t base = hull.size();
        for (const Point& p : points) {
            while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) {
                hull.pop_back();
            }
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

double least_width_m(std::span<const Point> polygon) {
    if (polygon.size() < 3) return 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < polygon.size(); ++e) {
        const Point &a = polygon[e], &b = polygon[(e + 1) % polygon.size()];
        const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
        if (length <= 0) continue;
        double reach = 0;
        for (const Point& p : polygon) reach = std::max(reach, std::abs(turn(a, b, p)) / length);
        least = std::min(least, reach);
    }
    return least;
}

}  // namespace topple::physics
