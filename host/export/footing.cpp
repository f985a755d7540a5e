// SPDX-License-Identifier: MIT
#include "export/footing.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "export/separate.h"
#include "export/touching.h"
#include "physics/infinity.h"
#include "physics/tipping.h"

namespace topple::exports {
namespace {

// Where the plumb line through a point lies in a part, and how level the part is where it comes out
// above: the cosine of the slope.
struct Plumb {
    double low = -physics::infinity, high = physics::infinity;
    double level = 0;
};
std::optional<Plumb> plumb(const ConvexPart& part, const Point2& p) {
    if (p[0] < part.low[0] || p[0] > part.high[0] || p[1] < part.low[1] || p[1] > part.high[1])
        return std::nullopt;
    Plumb out;
    for (const HalfSpace& side : part.face) {
        const double flat = side.normal[0] * p[0] + side.normal[1] * p[1];
        if (std::abs(side.normal[2]) < 1e-9) {
            if (flat > side.offset_m) return std::nullopt;
            continue;
        }
        const double z = (side.offset_m - flat) / side.normal[2];
        if (side.normal[2] > 0) {
            if (z < out.high) {
                out.high = z;
                out.level = side.normal[2];
            }
        } else {
            out.low = std::max(out.low, z);
        }
    }
    if (out.low > out.high) return std::nullopt;
    return out;
}

}  // namespace

std::vector<Point2> footing_of(const std::vector<Body>& bodies, const std::vector<bool>& stands,
                               const Body& body) {
    std::vector<Point2> out;
    const Extents<double> box = box_around(body.parts);
    for (std::size_t n = 0; n < bodies.size(); ++n) {
        if (!stands[n] || &bodies[n] == &body) continue;
        for (const ConvexPart& below : bodies[n].parts) {
            if (!near(box, below, resting_m)) continue;
            for (const ConvexPart& part : body.parts) {
                const Touch touch = touch_of(below, part);
                if (touch.normal[2] < carries_cosine) continue;
                for (const Vec3& p : touch.point) out.push_back({p[0], p[1]});
            }
        }
    }
    return out;
}

double margin_m(const std::vector<Point2>& points, const Vec3& center_m) {
    if (points.empty()) return -physics::infinity;
    return physics::footing(physics::convex_polygon(points), center_m[0], center_m[1]).margin_m;
}

std::optional<Gap> gap_below(const std::vector<Body>& bodies, const std::vector<bool>& stands,
                             const Body& body, const Point2& at) {
    constexpr double same_m = 1e-5;
    constexpr double steep_cosine = 0.3;
    Gap gap{physics::infinity, -physics::infinity};
    for (const ConvexPart& part : body.parts)
        if (const auto line = plumb(part, at)) gap.from_m = std::min(gap.from_m, line->low);
    if (!std::isfinite(gap.from_m)) return std::nullopt;
    bool carries = false;
    for (std::size_t n = 0; n < bodies.size(); ++n) {
        if (&bodies[n] == &body) continue;
        for (const ConvexPart& part : bodies[n].parts) {
            const auto line = plumb(part, at);
            // What reaches higher is beside it.
            if (!line || line->high > gap.from_m + same_m || line->high <= gap.to_m) continue;
            gap.to_m = std::min(line->high, gap.from_m);
            gap.on = n;
            carries = stands[n] && line->level >= steep_cosine;
        }
    }
    if (!carries) return std::nullopt;
    return gap;
}

}  // namespace topple::exports
