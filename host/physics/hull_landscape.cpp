// SPDX-License-Identifier: MIT
#include "physics/hull_landscape.h"

#include <algorithm>
#include <numbers>
#include <string>

#include "core/short_number.h"
#include "physics/hull_polytope.h"
#include "physics/tipping.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

constexpr double rounding = 1e-12;  // of the radius

void add_contacts(HullPose& pose, const HullPolytope& hull, const Vec3& normal, double height,
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
    for (std::size_t n = 0; n < hull.points.size(); ++n) {
        const Vec3& p = hull.points[n];
        if (dot(p, normal) < height - reach) continue;
        pose.contacts.push_back(static_cast<std::uint32_t>(n));
        shadow.push_back({dot(p, u), dot(p, w)});
    }
    pose.margin_m = footing(convex_polygon(std::move(shadow)), 0, 0).margin_m * hull.radius;
}

std::vector<HullPose> make_poses(const HullPolytope& hull, const MergeTree& tree,
                                 double resolution) {
    const std::vector<double> angle = basin_angles(hull);
    std::vector<HullPose> poses(tree.basins.size());
    for (std::size_t n = 0; n < poses.size(); ++n) {
        const MergeTree::Basin& basin = tree.basins[n];
        HullPose& pose = poses[n];
        const HullPolytope::Face& face = hull.face[basin.minimum];
        pose.up = opposite(face.normal);
        pose.height_m = face.height * hull.radius;
        pose.joins_at_m = basin.pass * hull.radius;
        pose.joins = basin.parent;
        add_contacts(pose, hull, face.normal, face.height, std::max(resolution, hull_flat));
    }
    for (HullPose& pose : poses) pose.barrier_m = pose.joins_at_m - pose.height_m;
    for (const HullPose& pose : poses) {
        if (pose.joins < 0) continue;
        HullPose& deeper = poses[pose.joins];
        deeper.barrier_m = std::min(deeper.barrier_m, pose.joins_at_m - deeper.height_m);
    }
    for (std::size_t f = 0; f < angle.size(); ++f) {
        poses[tree.basin_of[f]].probability += angle[f] / (4 * std::numbers::pi);
    }
    return poses;
}

std::vector<HullPass> make_passes(const HullPolytope& hull, const MergeTree& tree, bool borders) {
    std::vector<HullPass> passes;
    for (const HullPolytope::Edge& e : hull.edge) {
        if (!e.pass()) continue;
        HullPass pass;
        pass.up = opposite(unit(e.foot));
        pass.height_m = e.highest * hull.radius;
        for (std::size_t side = 0; side < 2; ++side) {
            pass.points[side] = hull.point[e.end[side]];
            pass.poses[side] = tree.basin_of[descend(hull, e.face[side])];
        }
        if (borders && pass.poses[0] != pass.poses[1]) {
            for (const Vec3& n : border_over(hull, e)) pass.border.push_back(opposite(n));
        }
        passes.push_back(std::move(pass));
    }
    std::stable_sort(passes.begin(), passes.end(),
                     [](const HullPass& a, const HullPass& b) { return a.height_m < b.height_m; });
    return passes;
}

}  // namespace

HullLandscape hull_landscape(std::span<const Vec3> points, const Vec3& center_of_mass,
                             const HullOptions& options) {
    return hull_landscape(hull_polytope(points, center_of_mass), options);
}

HullLandscape hull_landscape(const HullPolytope& hull, const HullOptions& options) {
    if (!(options.resolution_m >= 0) || !std::isfinite(options.resolution_m)) {
        throw Error(ErrorKind::input, "hull_landscape: a resolution of " +
                                          short_number(options.resolution_m) +
                                          " m; it must be 0 or more");
    }
    const double resolution = std::max(options.resolution_m / hull.radius, rounding);
    const MergeTree tree = merge_tree(hull, resolution);
    HullLandscape result;
    result.poses = make_poses(hull, tree, resolution);
    result.passes = make_passes(hull, tree, options.borders);
    result.corners = hull.point;
    const Vec3 down = opposite(options.up);
    result.now = tree.basin_of[descend(hull, down)];
    for (const Vec3& v : hull.corner)
        result.now_m = std::max(result.now_m, dot(v, down) * hull.radius);
    for (std::size_t n = 0; n < hull.corner.size(); ++n) {
        result.maxima +=
            std::none_of(hull.beside[n].begin(), hull.beside[n].end(), [&](std::uint32_t m) {
                const HullPolytope::Edge& e = hull.edge[m];
                return e.inside[e.end[0] == n ? 0 : 1] < 0;
            });
    }
    result.highest_m = hull.radius;
    return result;
}

}  // namespace topple::physics
