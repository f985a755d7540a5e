// SPDX-License-Identifier: MIT
#include "physics/hull_landscape.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>

#include "physics/hull_polytope.h"
#include "physics/landscape.h"
#include "physics/qhull.h"
#include "physics/tipping.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double flat = 1e-9;       // of the extent: what spans less spans nothing
constexpr double rounding = 1e-12;  // of the radius

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
    std::ostringstream text;
    text << "hull_landscape: ";
    (text << ... << parts);
    throw Error(ErrorKind::input, text.str());
}

void check(std::span<const Vec3> points, const Vec3& center, const HullOptions& options) {
    const auto finite = [](const Vec3& v) {
        return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
    };
    if (!(options.resolution_m >= 0) || !std::isfinite(options.resolution_m)) {
        refuse("a resolution of ", options.resolution_m, " m; it must be 0 or more");
    }
    if (!finite(center)) refuse("the centre of mass is not finite");
    if (points.size() < 4) refuse(points.size(), " points span no volume; it takes four");
    for (std::size_t n = 0; n < points.size(); ++n) {
        if (!finite(points[n])) refuse("point ", n, " is not finite");
    }
}

// Relative to the centre of mass, in units of the largest distance from it, so that no square of a
// coordinate is too large or too small.
struct Scaled {
    std::vector<Vec3> point;
    double radius = 0;
};

Scaled scale(std::span<const Vec3> points, const Vec3& center) {
    Scaled scaled;
    double largest = 0;
    for (const Vec3& p : points) {
        for (std::size_t a = 0; a < 3; ++a) largest = std::max(largest, std::abs(p[a] - center[a]));
    }
    if (!(largest > 0)) refuse("all ", points.size(), " points are one point");
    if (!std::isfinite(largest)) refuse("the points are too far apart for double precision");
    for (const Vec3& p : points) {
        scaled.point.push_back({(p[0] - center[0]) / largest, (p[1] - center[1]) / largest,
                                (p[2] - center[2]) / largest});
        scaled.radius =
            std::max(scaled.radius, std::sqrt(dot(scaled.point.back(), scaled.point.back())));
    }
    for (Vec3& p : scaled.point) {
        for (double& x : p) x /= scaled.radius;
    }
    scaled.radius *= largest;
    return scaled;
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
    if (!(std::sqrt(off_line(c)) > flat * extent)) {
        refuse("all ", points.size(), " points are on one line");
    }
    const Vec3 normal = unit(cross(line, minus(c, a)));
    const auto off_plane = [&](const Vec3& p) {
        const double distance = dot(minus(p, a), normal);
        return distance * distance;
    };
    if (!(std::sqrt(off_plane(farthest(off_plane))) > flat * extent)) {
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
    e.highest = e.turns() ? std::sqrt(dot(e.foot, e.foot))
                          : std::max(hull.face[left].height, hull.face[right].height);
    const auto number = static_cast<std::uint32_t>(hull.edge.size());
    hull.edge.push_back(e);
    for (const std::uint32_t corner : e.end) hull.beside[corner].push_back(number);
    for (const std::uint32_t face : e.face) hull.face[face].edges.push_back(number);
}

HullPolytope make_polytope(const Scaled& scaled) {
    const auto found = convex_hull(scaled.point);
    if (!found) {
        check_volume(scaled.point);
        refuse("Qhull can build no hull of the ", scaled.point.size(), " points");
    }
    HullPolytope hull;
    std::vector<std::uint32_t> corner_of(scaled.point.size());
    for (const std::uint32_t n : found->vertices) {
        corner_of[n] = static_cast<std::uint32_t>(hull.corner.size());
        hull.corner.push_back(scaled.point[n]);
        hull.point.push_back(n);
    }
    hull.beside.resize(hull.corner.size());
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> left;  // face of each directed edge
    for (std::vector<std::uint32_t> loop : found->faces) {
        for (std::uint32_t& n : loop) n = corner_of[n];
        HullPolytope::Face face;
        face.normal = normal_of(hull.corner, loop);
        face.height = -infinity;
        for (const std::uint32_t n : loop) {
            face.height = std::max(face.height, dot(hull.corner[n], face.normal));
        }
        for (std::size_t n = 0; n < loop.size(); ++n) {
            left[{loop[n], loop[(n + 1) % loop.size()]}] =
                static_cast<std::uint32_t>(hull.face.size());
        }
        hull.face.push_back(std::move(face));
    }
    for (const auto& [ends, face] : left) {
        const auto twin = left.find({ends[1], ends[0]});
        if (twin == left.end()) refuse("the hull of the points does not close");
        if (ends[0] < ends[1]) add_edge(hull, ends[0], ends[1], face, twin->second);
    }
    for (std::size_t f = 0; f < hull.face.size(); ++f) {
        HullPolytope::Face& face = hull.face[f];
        face.minimum = std::all_of(face.edges.begin(), face.edges.end(), [&](std::uint32_t n) {
            const HullPolytope::Edge& e = hull.edge[n];
            return e.margin[e.face[0] == f ? 0 : 1] > 0;
        });
    }
    return hull;
}

// Nodes are the faces, then the edges.
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

void add_contacts(HullPose& pose, const Scaled& scaled, const Vec3& normal, double height,
                  double reach) {
    // A basis of the plane, from the axis that its normal has least of.
    Vec3 axis{};
    std::size_t least = 0;
    for (std::size_t a = 1; a < 3; ++a) {
        if (std::abs(normal[a]) < std::abs(normal[least])) least = a;
    }
    axis[least] = 1;
    const Vec3 u = unit(cross(normal, axis)), w = cross(normal, u);
    std::vector<std::array<double, 2>> shadow;
    for (std::size_t n = 0; n < scaled.point.size(); ++n) {
        const Vec3& p = scaled.point[n];
        if (dot(p, normal) < height - reach) continue;
        pose.contacts.push_back(static_cast<std::uint32_t>(n));
        shadow.push_back({dot(p, u), dot(p, w)});
    }
    pose.margin_m = footing(convex_polygon(std::move(shadow)), 0, 0).margin_m * scaled.radius;
}

Vec3 upwards(const Vec3& down) {
    return {-down[0], -down[1], -down[2]};
}

std::vector<HullPose> make_poses(const HullPolytope& hull, const MergeTree& tree,
                                 const Scaled& scaled, double resolution) {
    const std::vector<double> angle = basin_angles(hull);
    std::vector<HullPose> poses(tree.basins.size());
    for (std::size_t n = 0; n < poses.size(); ++n) {
        const MergeTree::Basin& basin = tree.basins[n];
        HullPose& pose = poses[n];
        const HullPolytope::Face& face = hull.face[basin.minimum];
        pose.up = upwards(face.normal);
        pose.height_m = face.height * scaled.radius;
        pose.joins_at_m = basin.pass * scaled.radius;
        pose.joins = basin.parent;
        add_contacts(pose, scaled, face.normal, face.height, std::max(resolution, flat));
    }
    for (HullPose& pose : poses) pose.barrier_m = pose.joins_at_m - pose.height_m;
    for (const HullPose& pose : poses) {
        if (pose.joins < 0) continue;
        HullPose& deeper = poses[static_cast<std::size_t>(pose.joins)];
        deeper.barrier_m = std::min(deeper.barrier_m, pose.joins_at_m - deeper.height_m);
    }
    for (std::size_t f = 0; f < angle.size(); ++f) {
        poses[static_cast<std::size_t>(tree.basin_of[f])].probability +=
            angle[f] / (4 * std::numbers::pi);
    }
    return poses;
}

std::vector<HullPass> make_passes(const HullPolytope& hull, const MergeTree& tree, double radius) {
    std::vector<HullPass> passes;
    for (const HullPolytope::Edge& e : hull.edge) {
        if (!e.pass()) continue;
        HullPass pass;
        pass.up = upwards(unit(e.foot));
        pass.height_m = e.highest * radius;
        for (std::size_t side = 0; side < 2; ++side) {
            pass.points[side] = hull.point[e.end[side]];
            pass.poses[side] = tree.basin_of[descend(hull, e.face[side])];
        }
        passes.push_back(pass);
    }
    std::stable_sort(passes.begin(), passes.end(),
                     [](const HullPass& a, const HullPass& b) { return a.height_m < b.height_m; });
    return passes;
}

}  // namespace

HullLandscape hull_landscape(std::span<const Vec3> points, const Vec3& center_of_mass,
                             const HullOptions& options) {
    check(points, center_of_mass, options);
    const Scaled scaled = scale(points, center_of_mass);
    check_volume(scaled.point);
    const HullPolytope hull = make_polytope(scaled);
    for (const auto& face : hull.face) {
        if (!(face.height > flat)) {
            refuse("the centre of mass is not inside of the hull: it lies ",
                   -face.height * scaled.radius, " m beyond a face");
        }
    }
    const double resolution = std::max(options.resolution_m / scaled.radius, rounding);
    const MergeTree tree = merge_tree(hull, resolution);
    HullLandscape result;
    result.poses = make_poses(hull, tree, scaled, resolution);
    result.passes = make_passes(hull, tree, scaled.radius);
    for (std::size_t n = 0; n < hull.corner.size(); ++n) {
        result.maxima +=
            std::none_of(hull.beside[n].begin(), hull.beside[n].end(), [&](std::uint32_t m) {
                const HullPolytope::Edge& e = hull.edge[m];
                return e.inside[e.end[0] == n ? 0 : 1] < 0;
            });
    }
    result.highest_m = scaled.radius;
    return result;
}

}  // namespace topple::physics
