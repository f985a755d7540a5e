// SPDX-License-Identifier: MIT
#include "export/convex_part.h"

#include <algorithm>
#include <cmath>

#include "physics/qhull.h"
#include "physics/vectors.h"

namespace topple::exports {
namespace {

using physics::along;
using physics::cross;
using physics::dot;
using physics::minus;
using physics::unit;

// Newell's normal, not of unit length: of a polygon that is flat only to within rounding.
Vec3 newell(const std::vector<Vec3>& corner, const std::vector<std::uint32_t>& outline) {
    Vec3 sum{};
    for (std::size_t n = 0; n < outline.size(); ++n)
        sum = along(sum, 1, cross(corner[outline[n]], corner[outline[(n + 1) % outline.size()]]));
    return sum;
}

// Adds up cones from the first corner to each face.
double volume_of(const ConvexPart& part) {
    double six = 0;
    for (const auto& outline : part.outline) {
        const Vec3 a = minus(part.corner[outline[0]], part.corner[0]);
        for (std::size_t n = 1; n + 1 < outline.size(); ++n) {
            const Vec3 b = minus(part.corner[outline[n]], part.corner[0]);
            const Vec3 c = minus(part.corner[outline[n + 1]], part.corner[0]);
            six += dot(a, cross(b, c));
        }
    }
    return six / 6;
}

}  // namespace

std::optional<ConvexPart> hull_part(std::span<const Vec3> points) {
    const auto hull = physics::convex_hull(points);
    if (!hull) return std::nullopt;
    ConvexPart out;
    std::vector<std::uint32_t> number(points.size(), 0);
    for (const std::uint32_t v : hull->vertices) {
        number[v] = static_cast<std::uint32_t>(out.corner.size());
        out.corner.push_back(points[v]);
    }
    for (const auto& face : hull->faces) {
        auto& outline = out.outline.emplace_back();
        for (const std::uint32_t v : face) outline.push_back(number[v]);
        const Vec3 normal = newell(out.corner, outline);
        if (!(dot(normal, normal) > 0)) {
            out.outline.pop_back();
            continue;
        }
        HalfSpace side{unit(normal), -physics::infinity};
        for (const std::uint32_t v : outline)
            side.offset_m = std::max(side.offset_m, dot(side.normal, out.corner[v]));
        out.face.push_back(side);
    }
    out.volume_m3 = volume_of(out);
    if (!(out.volume_m3 > 0)) return std::nullopt;
    out.low = out.high = out.corner[0];
    for (const Vec3& c : out.corner) {
        for (std::size_t a = 0; a < 3; ++a) {
            out.low[a] = std::min(out.low[a], c[a]);
            out.high[a] = std::max(out.high[a], c[a]);
        }
    }
    return out;
}

std::optional<ConvexPart> reshaped(const ConvexPart& part, std::span<const Vec3> points) {
    auto out = hull_part(points);
    if (!out) return out;
    out->solid = part.solid;
    out->solid_each_m3 = part.solid_each_m3;
    return out;
}

std::optional<ConvexPart> cut(const ConvexPart& part, const HalfSpace& to) {
    std::vector<double> beyond;
    for (const Vec3& c : part.corner) beyond.push_back(dot(to.normal, c) - to.offset_m);
    if (std::ranges::all_of(beyond, [](double d) { return d <= 0; })) return part;
    std::vector<Vec3> points;
    for (std::size_t n = 0; n < part.corner.size(); ++n)
        if (beyond[n] <= 0) points.push_back(part.corner[n]);
    for (const auto& outline : part.outline) {
        for (std::size_t n = 0; n < outline.size(); ++n) {
            const std::uint32_t a = outline[n], b = outline[(n + 1) % outline.size()];
            // Each edge has two faces, which walk it in opposite directions.
            if (a > b || (beyond[a] > 0) == (beyond[b] > 0)) continue;
            const double t = beyond[a] / (beyond[a] - beyond[b]);
            points.push_back(along(part.corner[a], t, minus(part.corner[b], part.corner[a])));
        }
    }
    auto out = hull_part(points);
    if (!out) return out;
    out->solid_each_m3 = part.solid_each_m3;
    for (const Vec3& p : part.solid)
        if (dot(to.normal, p) <= to.offset_m + on_plane_m) out->solid.push_back(p);
    return out;
}

ConvexPart moved(ConvexPart part, const Vec3& by) {
    for (Vec3& c : part.corner) c = along(c, 1, by);
    for (Vec3& c : part.solid) c = along(c, 1, by);
    for (HalfSpace& side : part.face) side.offset_m += dot(side.normal, by);
    part.low = along(part.low, 1, by);
    part.high = along(part.high, 1, by);
    return part;
}

Extent extent_along(const ConvexPart& part, const Vec3& n) {
    Extent out{physics::infinity, -physics::infinity};
    for (const Vec3& c : part.corner) {
        const double d = dot(n, c);
        out.low = std::min(out.low, d);
        out.high = std::max(out.high, d);
    }
    return out;
}

std::array<Vec3, 8> Box::corners() const {
    std::array<Vec3, 8> out;
    for (std::size_t n = 0; n < 8; ++n) {
        out[n] = center;
        for (std::size_t a = 0; a < 3; ++a)
            out[n] = along(out[n], (n >> a & 1) != 0 ? half_m[a] : -half_m[a], axis[a]);
    }
    return out;
}

std::optional<Box> as_box(const ConvexPart& part, double tolerance_m) {
    // The two largest faces that are about square to one another give the axes.
    std::vector<double> area;
    for (const auto& outline : part.outline) {
        const Vec3 n = newell(part.corner, outline);
        area.push_back(std::sqrt(dot(n, n)) / 2);
    }
    if (area.size() < 6) return std::nullopt;
    const auto first = static_cast<std::size_t>(std::ranges::max_element(area) - area.begin());
    const Vec3 u = part.face[first].normal;
    constexpr double square = 0.1;  // cosine
    double largest = 0;
    Vec3 v{};
    for (std::size_t n = 0; n < area.size(); ++n) {
        if (std::abs(dot(u, part.face[n].normal)) > square || area[n] <= largest) continue;
        largest = area[n];
        v = part.face[n].normal;
    }
    if (largest == 0) return std::nullopt;
    Box box;
    v = unit(along(v, -dot(u, v), u));
    box.axis = {u, v, cross(u, v)};
    for (std::size_t a = 0; a < 3; ++a) {
        const Extent e = extent_along(part, box.axis[a]);
        box.half_m[a] = (e.high - e.low) / 2;
        box.center = along(box.center, (e.high + e.low) / 2, box.axis[a]);
    }
    // All of its corners lie within the part's half-spaces, or nearly so.
    for (const Vec3& c : box.corners())
        for (const HalfSpace& side : part.face)
            if (dot(side.normal, c) - side.offset_m > tolerance_m) return std::nullopt;
    return box;
}

}  // namespace topple::exports
