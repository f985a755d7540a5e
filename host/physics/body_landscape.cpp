// SPDX-License-Identifier: MIT
#include "physics/body_landscape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/union_find.h"
#include "physics/hull_landscape.h"

namespace topple::physics {
namespace {

constexpr Vec3 as_scanned{0, 0, 1};

Landscape of_hull(const HullPolytope& hull, double weight_N, double resolution_m) {
    HullLandscape found = hull_landscape(hull, {.resolution_m = resolution_m, .borders = true});
    const auto joules = [&](double height_m) { return weight_N * (height_m - found.now_m); };
    Landscape out;
    for (const Vec3& v : hull.corner) out.hull_m.push_back(along({}, hull.radius, v));
    for (const HullPose& pose : found.poses)
        out.poses.push_back({pose.up, joules(pose.height_m), 0, -1, pose.probability});
    for (HullPass& pass : found.passes) {
        if (pass.poses[0] == pass.poses[1]) continue;
        out.passes.push_back({pass.up, joules(pass.height_m), pass.poses, std::move(pass.border)});
    }
    out.now = found.now;
    return out;
}

// Keeps poses by rising energy. Its number.
std::int32_t insert_pose(const Landscape::Pose& pose, Landscape& l) {
    const auto at =
        std::ranges::upper_bound(l.poses, pose.energy_J, {}, &Landscape::Pose::energy_J);
    const auto number = static_cast<std::int32_t>(at - l.poses.begin());
    l.poses.insert(at, pose);
    const auto shift = [&](std::int32_t& n) { n += n >= number; };
    shift(l.now);
    for (Landscape::Pass& pass : l.passes) std::ranges::for_each(pass.poses, shift);
    return number;
}

// What stood is in a pose of its own, however shallow, though the hull by itself would leave it. So
// is what hangs: its hull's are those in which it could stand.
void add_pose_as_scanned(bool hangs, Landscape& l) {
    constexpr double alike = 1e-6;  // of unit directions
    const bool none = l.poses.empty();
    if (hangs || none || dot(l.poses[l.now].up, as_scanned) < 1 - alike) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        const std::int32_t now = insert_pose({as_scanned, 0, 0, -1, none ? nan : 0}, l);
        if (!none)
            l.passes.push_back(
                {as_scanned, std::numeric_limits<double>::infinity(), {now, l.now}, {}});
        l.now = now;
    }
    Landscape::Pose& now = l.poses[l.now];
    now.up = as_scanned;
    now.energy_J = 0;
}

// Turned by the angle about a level axis, so that it leans that way.
Vec3 leaning(const Vec3& way, double angle) {
    return {-std::sin(angle) * way[0], -std::sin(angle) * way[1], std::cos(angle)};
}

// Up where it is over the edge: at b beside a centre of mass at height h that is atan(b / h).
Vec3 top_of(const TippingWay& way, double height_m) {
    if (way.direction == Vec3{} || !(height_m > 0)) return as_scanned;
    return leaning(way.direction, std::acos(height_m / (height_m + way.climb_m)));
}

// The pass nearest to the way's direction that leads from the pose as scanned to one no higher than
// the way's top; none where there is none.
Landscape::Pass* pass_of(const TippingWay& way, double energy_J, Landscape& l) {
    const auto no_higher = [&](std::int32_t pose) { return l.poses[pose].energy_J <= energy_J; };
    Landscape::Pass* nearest = nullptr;
    double most = 0;
    for (Landscape::Pass& pass : l.passes) {
        const auto [a, b] = pass.poses;
        if (!(a == l.now && no_higher(b)) && !(b == l.now && no_higher(a))) continue;
        const double cosine = dot(leaning(way.direction, 1), pass.up);
        if (nearest && cosine <= most) continue;
        nearest = &pass;
        most = cosine;
    }
    return nearest;
}

// The support may make a pass lower than the hull on a level plane does. Where that leads to no
// pose on the plane, the body falls off its support: a pose of no depth stands there. What neither
// climbs nor comes lower rolls about in its basin.
void take_ways(const std::vector<TippingWay>& ways, double height_m, double weight_N,
               Landscape& l) {
    for (const TippingWay& way : ways) {
        if (!(way.climb_m > 0) && !(way.release_m > 0)) continue;
        const double energy_J = weight_N * way.climb_m;
        const Vec3 up = top_of(way, height_m);
        if (Landscape::Pass* const pass = pass_of(way, energy_J, l)) {
            if (energy_J >= pass->energy_J) continue;
            pass->energy_J = energy_J;
            pass->up = up;
        } else {
            const std::int32_t pose = insert_pose({up, energy_J, 0, -1, 0}, l);
            l.passes.push_back({up, energy_J, {l.now, pose}, {}});
        }
    }
    for (Landscape::Pass& pass : l.passes)
        if (std::isinf(pass.energy_J)) pass.energy_J = 0;  // nothing keeps it as it was scanned
    std::ranges::stable_sort(l.passes, {}, &Landscape::Pass::energy_J);
}

// The disconnectivity graph: as the energy rises, basins join that of the deepest.
void join_poses(Landscape& l) {
    for (Landscape::Pose& pose : l.poses) {
        pose.joins_at_J = std::numeric_limits<double>::infinity();
        pose.joins = -1;
    }
    UnionFind basins(l.poses.size());  // the lowest number is the deepest pose
    for (const Landscape::Pass& pass : l.passes) {
        const auto [deeper, joining] =
            std::minmax({basins.root(static_cast<std::size_t>(pass.poses[0])),
                         basins.root(static_cast<std::size_t>(pass.poses[1]))});
        if (deeper == joining) continue;
        l.poses[joining].joins_at_J = pass.energy_J;
        l.poses[joining].joins = static_cast<std::int32_t>(deeper);
        basins.join(deeper, joining);
    }
}

}  // namespace

Landscape body_landscape(const StandingHull& hull, const Candidate& candidate,
                         const std::vector<TippingWay>& ways) {
    const double weight_N = candidate.body.mass_kg * gravity;
    Landscape out;
    if (hull.ways) out = of_hull(hull.ways->hull(), weight_N, hull.resolution_m);
    const double height = candidate.body.center[2] - candidate.support_height_m;
    add_pose_as_scanned(is_held(candidate) && height <= 0, out);
    take_ways(ways, height, weight_N, out);
    join_poses(out);
    return out;
}

}  // namespace topple::physics
