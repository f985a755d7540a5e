// SPDX-License-Identifier: MIT
#include "physics/hull_polytope.h"

#include <algorithm>
#include <locale>
#include <sstream>

#include "physics/infinity.h"
#include "physics/qhull.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "hull_landscape: ";
    (text << ... << parts);
    throw Error(ErrorKind::input, text.str());
}

void check(std::span<const Vec3> points, const Vec3& center) {
    const auto finite = [](const Vec3& v) {
        return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
    };
    if (!finite(center)) refuse("the centre of mass is not finite");
    if (points.size() < 4) refuse(points.size(), " points span no volume; it takes four");
    for (std::size_t n = 0; n < points.size(); ++n) {
        if (!finite(points[n])) refuse("point ", n, " is not finite");
    }
}

// Relative to the centre of mass, in units of the largest distance from it, so that no square of a
// coordinate is too large or too small.
void scale(HullPolytope& hull, std::span<const Vec3> points, const Vec3& center) {
    double largest = 0;
    for (const Vec3& p : points) {
        for (std::size_t a = 0; a < 3; ++a) largest = std::max(largest, std::abs(p[a] - center[a]));
    }
    if (!(largest > 0)) refuse("all ", points.size(), " points are one point");
    if (!std::isfinite(largest)) refuse("the points are too far apart for double precision");
    for (const Vec3& p : points) {
        hull.points.push_back({(p[0] - center[0]) / largest, (p[1] - center[1]) / largest,
                               (p[2] - center[2]) / largest});
        hull.radius = std::max(hull.radius, std::sqrt(dot(hull.points.back(), hull.points.back())));
    }
    for (Vec3& p : hull.points) {
        for (double& x : p) x /= hull.radius;
    }
    hull.radius *= largest;
}

// Says what is wrong with points that span no volume.
void check_volume(const std::vector<Vec3>& points) {
    const auto farthest = [&](const auto& distance2) {
        return *std::max_element(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) {
            return distance2(p) < distance2(q);
        });
    };
    const auto square = [](const Vec3& v) { return dot(v, v); };
    const Vec3 a = points[0];
    const Vec3 b = farthest([&](const Vec3& p) { return square(minus(p, a)); });
    const double extent = std::sqrt(square(minus(b, a)));
    if (!(extent > 0)) refuse("all ", points.size(), " points are one point");
    const Vec3 line = unit(minus(b, a));
    const auto off_line = [&](const Vec3& p) { return square(cross(minus(p, a), line)); };
    const Vec3 c = farthest(off_line);
    if (!(std::sqrt(off_line(c)) > hull_flat * extent)) {
        refuse("all ", points.size(), " points are on one line");
    }
    const Vec3 normal = unit(cross(line, minus(c, a)));
    const auto off_plane = [&](const Vec3& p) {
        const double distance = dot(minus(p, a), normal);
        return distance * distance;
    };
    if (!(std::sqrt(off_plane(farthest(off_plane))) > hull_flat * extent)) {
        refuse("all ", points.size(), " points are in one plane");
    }
}

Vec3 normal_of(const std::vector<Vec3>& corner, const std::vector<std::uint32_t>& loop) {
    Vec3 sum{};
    for (std::size_t n = 1; n + 1 < loop.size(); ++n) {
        sum = along(sum, 1,
                    cross(minus(corner[loop[n]], corner[loop[0]]),
                          minus(corner[loop[n + 1]], corner[loop[0]])));
    }
    return unit(sum);
}

void add_edge(HullPolytope& hull, std::uint32_t a, std::uint32_t b, std::uint32_t left,
              std::uint32_t right) {
    HullPolytope::Edge e;
    e.end = {a, b};
    e.face = {left, right};
    const Vec3 &from = hull.corner[a], &to = hull.corner[b], span = minus(to, from);
    e.inside = {-dot(from, span), dot(to, span)};
    const double length2 = e.inside[0] + e.inside[1];
    e.foot = along(from, e.inside[0] / length2, span);
    const auto margin = [&](std::uint32_t face, const Vec3& forward) {
        return -dot(from, cross(hull.face[face].normal, forward)) / std::sqrt(length2);
    };
    e.margin = {margin(left, span), margin(right, minus(from, to))};
    // Never below its faces, whatever rounding says: an edge is no minimum.
    e.highest = std::max(hull.face[left].height, hull.face[right].height);
    if (e.turns()) e.highest = std::max(e.highest, std::sqrt(dot(e.foot, e.foot)));
    const auto number = static_cast<std::uint32_t>(hull.edge.size());
    hull.edge.push_back(e);
    for (const std::uint32_t corner : e.end) hull.beside[corner].push_back(number);
    for (const std::uint32_t face : e.face) hull.face[face].edges.push_back(number);
}

}  // namespace

HullPolytope hull_polytope(std::span<const Vec3> all, const Vec3& center) {
    check(all, center);
    HullPolytope hull;
    scale(hull, all, center);
    check_volume(hull.points);
    const auto found = convex_hull(hull.points);
    if (!found) refuse("Qhull can build no hull of the ", hull.points.size(), " points");
    std::vector<std::uint32_t> corner_of(hull.points.size());
    for (const std::uint32_t n : found->vertices) {
        corner_of[n] = static_cast<std::uint32_t>(hull.corner.size());
        hull.corner.push_back(hull.points[n]);
        hull.point.push_back(n);
    }
    hull.beside.resize(hull.corner.size());
    struct Side {
        std::array<std::uint32_t, 2> ends;
        std::uint32_t face;  // to the left of the way from the first end to the second
    };
    std::vector<Side> sides;
    for (std::vector<std::uint32_t> loop : found->faces) {
        for (std::uint32_t& n : loop) n = corner_of[n];
        HullPolytope::Face face;
        face.normal = normal_of(hull.corner, loop);
        face.height = -infinity;
        for (const std::uint32_t n : loop) {
            face.height = std::max(face.height, dot(hull.corner[n], face.normal));
        }
        for (std::size_t n = 0; n < loop.size(); ++n) {
            sides.push_back({{loop[n], loop[(n + 1) % loop.size()]},
                             static_cast<std::uint32_t>(hull.face.size())});
        }
        hull.face.push_back(std::move(face));
    }
    std::ranges::sort(sides, {}, &Side::ends);
    for (const auto& [ends, face] : sides) {
        const std::array<std::uint32_t, 2> back{ends[1], ends[0]};
        const auto twin = std::ranges::lower_bound(sides, back, {}, &Side::ends);
        if (twin == sides.end() || twin->ends != back)
            refuse("the hull of the points does not close");
        if (ends[0] < ends[1]) add_edge(hull, ends[0], ends[1], face, twin->face);
    }
    for (std::size_t f = 0; f < hull.face.size(); ++f) {
        HullPolytope::Face& face = hull.face[f];
        face.minimum = std::all_of(face.edges.begin(), face.edges.end(), [&](std::uint32_t n) {
            const HullPolytope::Edge& e = hull.edge[n];
            return e.margin[e.face[0] == f ? 0 : 1] > 0;
        });
        if (!(face.height > hull_flat)) {
            refuse("the centre of mass is not inside of the hull: it lies ",
                   -face.height * hull.radius, " m beyond a face");
        }
    }
    return hull;
}

MergeTree merge_tree(const HullPolytope& hull, double resolution) {
    const std::size_t faces = hull.face.size();
    std::vector<double> height;
    std::vector<std::vector<std::uint32_t>> neighbours(faces + hull.edge.size());
    for (const auto& f : hull.face) height.push_back(f.height);
    for (std::size_t n = 0; n < hull.edge.size(); ++n) {
        height.push_back(hull.edge[n].highest);
        for (const std::uint32_t f : hull.edge[n].face) {
            neighbours[faces + n].push_back(f);
            neighbours[f].push_back(static_cast<std::uint32_t>(faces + n));
        }
    }
    return disconnectivity_graph(height, neighbours, resolution);
}

}  // namespace topple::physics
