// SPDX-License-Identifier: MIT
#include "pipeline/landing.h"

#include <algorithm>
#include <cmath>

#include "physics/landscape.h"

namespace topple {
namespace {

double support_m(const StableObject& from) {
    return from.candidate.support_polygon.empty() ? from.lowest_m : from.candidate.support_height_m;
}

physics::Swept swept(const SolidParts& parts, const physics::HiddenWalls& walls,
                     const StableObject& from) {
    const physics::Instability& how = from.instability;
    const Vec3& center = from.candidate.body.center;
    const Vec3& way = how.weakest;
    const double support = support_m(from), height = std::max(center[2] - support, 0.0);
    if (how.mode == "slide") {
        const double on = from.sliding.distance_m + height;
        return {{center[0] + on * way[0], center[1] + on * way[1], center[2] - how.drop_m}};
    }
    double beside = 0;  // from the centre of mass to the edge
    if (how.edge) {
        const auto& [a, b] = *how.edge;
        for (std::size_t c = 0; c < 2; ++c) beside += ((a[c] + b[c]) / 2 - center[c]) * way[c];
    }
    physics::Swept out =
        physics::sweep_over_edge(parts.solids->cells(), parts.solids->columns(), walls,
                                 from.candidate, support, way, beside, from.highest_m);
    if (!out.stopped) out.center[2] -= how.drop_m;
    return out;
}

// How far an object reaches from its centre of mass: along its easiest way, to the left of it, and
// to the right; or all around where it may go any way.
struct Reach {
    double ahead = 0, left = 0, right = 0, around = 0;
};
std::vector<Reach> reaches(const SolidScene& solids, const ObjectStage& objects) {
    std::vector<Reach> out(objects.objects.size());
    const SolidCells& cells = solids.cells();
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (cells.primitive[c] < 0) continue;
        const auto primitive = static_cast<std::size_t>(cells.primitive[c]);
        if (objects.object_of_primitive[primitive] < 0) continue;
        const auto o = static_cast<std::size_t>(objects.object_of_primitive[primitive]);
        const StableObject& object = objects.objects[o];
        if (object.grounded) continue;
        const Vec3 &center = object.candidate.body.center, &way = object.instability.weakest;
        const double x = (cells.i[c] + 0.5) * cells.voxel_m - center[0];
        const double y = (cells.j[c] + 0.5) * cells.voxel_m - center[1];
        const double left = y * way[0] - x * way[1], half = cells.voxel_m / 2;
        Reach& reach = out[o];
        reach.ahead = std::max(reach.ahead, x * way[0] + y * way[1] + half);
        reach.left = std::max(reach.left, left + half);
        reach.right = std::max(reach.right, half - left);
        reach.around = std::max(reach.around, std::hypot(x, y) + half);
    }
    return out;
}

safety::FallZone zone(const StableObject& from, const physics::Swept& swept, const Reach& reach) {
    const Vec3 &center = from.candidate.body.center, &way = from.instability.weakest;
    const double support = support_m(from), height = from.highest_m - from.lowest_m;
    safety::FallZone out;
    out.from = center;
    out.way = way;
    out.left_m = reach.left;
    out.right_m = reach.right;
    out.lowest_m = std::min(support, from.lowest_m) - from.instability.drop_m;
    out.highest_m = from.highest_m;
    const double on = std::hypot(swept.center[0] - center[0], swept.center[1] - center[1]);
    const bool lies_down =
        from.instability.mode != "slide" && (swept.stopped || !(from.instability.drop_m > 0));
    const double beyond =
        lies_down ? from.highest_m - center[2] : std::max(reach.ahead, height / 2);
    out.ahead_m = on + std::max(beyond, 0.0);
    if (way == Vec3{}) out.ahead_m = std::max(reach.around, height / 2);
    return out;
}

double hits_J(const StableObject& from, const physics::Swept& swept) {
    const physics::Instability& how = from.instability;
    if (!swept.stopped) return how.release_J;
    const physics::Body& body = from.candidate.body;
    const double sinks_m = body.center[2] - swept.center[2];
    return std::clamp(how.barrier_J + body.mass_kg * physics::gravity * sinks_m, 0.0,
                      how.release_J);
}

}  // namespace

std::vector<Landing> landings(const SolidParts& parts, const ObjectStage& objects) {
    const std::vector<Reach> reach = reaches(*parts.solids, objects);
    std::vector<Landing> out(objects.objects.size());
    for (std::size_t o = 0; o < out.size(); ++o) {
        const StableObject& from = objects.objects[o];
        if (from.grounded) continue;
        out[o].swept = swept(parts, objects.hidden_walls, from);
        out[o].hits_J = hits_J(from, out[o].swept);
        out[o].zone = zone(from, out[o].swept, reach[o]);
    }
    return out;
}

}  // namespace topple
