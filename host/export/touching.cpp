// SPDX-License-Identifier: MIT
#include "export/touching.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vectors.h"
#include "export/separate.h"
#include "physics/tipping.h"

namespace topple::exports {
namespace {

using Polygon = std::vector<std::array<double, 2>>;

// Coordinates in a plane.
struct Plane {
    Vec3 normal{}, u{}, v{};
    double offset_m = 0;
    Plane(const Vec3& n, double offset) : normal(n), offset_m(offset) {
        const Vec3 far = std::abs(n[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        u = unit(cross(far, n));
        v = cross(n, u);
    }
    Vec3 at(const std::array<double, 2>& p) const {
        return along(
            along({offset_m * normal[0], offset_m * normal[1], offset_m * normal[2]}, p[0], u),
            p[1], v);
    }
    // The outline of what of a part lies in the plane, counter-clockwise as seen against the
    // normal.
    Polygon outline(const ConvexPart& part, double offset) const {
        Polygon out;
        for (const Vec3& c : part.corner)
            if (std::abs(dot(normal, c) - offset) <= resting_m)
                out.push_back({dot(u, c), dot(v, c)});
        return out.empty() ? out : physics::convex_polygon(std::move(out));
    }
};

// What of a polygon, which may be an edge or a point, lies in another one, both convex and
// counter-clockwise.
Polygon common(Polygon polygon, const Polygon& other) {
    if (other.size() < 3) return {};
    for (std::size_t n = 0; n < other.size() && !polygon.empty(); ++n) {
        const auto &a = other[n], &b = other[(n + 1) % other.size()];
        const auto inside = [&](const std::array<double, 2>& p) {
            return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        };
        Polygon left;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const auto &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
            const double at_p = inside(p), at_q = inside(q);
            if (at_p >= 0) left.push_back(p);
            if ((at_p >= 0) != (at_q >= 0)) {
                const double t = at_p / (at_p - at_q);
                left.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
            }
        }
        polygon = std::move(left);
    }
    return polygon;
}

}  // namespace

Touch touch_of(const ConvexPart& below, const ConvexPart& above) {
    Touch out;
    if (!near(above, below, resting_m)) return out;
    const Apart lie = apart(below, above);
    if (lie.gap_m > resting_m) return out;
    out.normal = lie.normal;
    const double top = extent_along(below, lie.normal).high;
    const Plane plane(lie.normal, top);
    Polygon under = plane.outline(below, top), over = plane.outline(above, top + lie.gap_m);
    if (under.size() < 3) std::swap(under, over);
    for (const auto& p : common(std::move(over), under)) out.point.push_back(plane.at(p));
    return out;
}

std::vector<Touch> touches_of(const std::vector<Body>& bodies, std::size_t first) {
    std::vector<Extents<double>> box;
    for (const Body& body : bodies) box.push_back(box_around(body.parts));
    std::vector<Touch> out;
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        for (std::size_t b = std::max(a + 1, first); b < bodies.size(); ++b) {
            if (bodies[a].fixed && bodies[b].fixed) continue;
            if (bodies[a].parts.empty() || bodies[b].parts.empty()) continue;
            if (!near(box[a], box[b], resting_m)) continue;
            for (const ConvexPart& below : bodies[a].parts) {
                if (!near(below, box[b], resting_m)) continue;
                for (const ConvexPart& above : bodies[b].parts) {
                    Touch touch = touch_of(below, above);
                    if (touch.point.empty()) continue;
                    touch.below = a;
                    touch.above = b;
                    out.push_back(std::move(touch));
                }
            }
        }
    }
    return out;
}

}  // namespace topple::exports
