// SPDX-License-Identifier: MIT
#include "safety/landing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "objects/stops.h"
#include "objects/taken_along.h"
#include "physics/landscape.h"

namespace topple {
namespace {

double support_m(const Body& from) {
    return from.candidate.support_polygon.empty() ? from.lowest_m : from.candidate.support_height_m;
}

// A way out of its pose.
struct Way {
    bool slides = false, easiest = true;
    Vec3 direction{};
    std::optional<physics::Ends> edge;
    double barrier_J = 0, release_J = 0, drop_m = 0;
};

Way easiest_way(const Body& from) {
    const physics::Instability& how = from.instability;
    const bool slides = how.mode == physics::Instability::Mode::slide;
    return {slides, true, how.weakest, how.edge, how.barrier_J, how.release_J, how.drop_m};
}

// The easiest one, but one on which it falls where that only comes to lean.
Way falling_way(const Body& from) {
    const Way out = easiest_way(from);
    if (out.slides || out.release_J > 0) return out;
    const physics::TippingWay* least = nullptr;
    for (const physics::TippingWay& way : from.tipping.ways)
        if (way.release_m > 0 && way.direction != Vec3{} &&
            (!least || way.climb_m < least->climb_m))
            least = &way;
    if (!least) return out;
    const double weight = from.candidate.body.mass_kg * physics::gravity;
    return {false,
            false,
            least->direction,
            least->edge,
            weight * least->climb_m,
            weight * least->release_m,
            least->drop_m};
}

physics::Swept swept(const SolidParts& parts, const physics::HiddenWalls& walls, const Body& from,
                     const Way& way, std::span<const std::int32_t> along,
                     const std::vector<bool>& stops = {}) {
    const Vec3& center = from.candidate.body.center;
    const double support = support_m(from), height = std::max(center[2] - support, 0.0);
    if (way.slides) {
        const double on = from.sliding.distance_m + height;
        return {{center[0] + on * way.direction[0], center[1] + on * way.direction[1],
                 center[2] - way.drop_m}};
    }
    double beside = 0;  // from the centre of mass to the edge
    if (way.edge) {
        const auto& [a, b] = *way.edge;
        for (std::size_t c = 0; c < 2; ++c)
            beside += ((a[c] + b[c]) / 2 - center[c]) * way.direction[c];
    }
    physics::Swept out = physics::sweep_over_edge(parts.solids->cells(), parts.solids->columns(),
                                                  walls, from.candidate, along, support,
                                                  way.direction, beside, from.highest_m, stops);
    // What has sunk nearly as low as it lies on its side lies, and leans on nothing.
    constexpr double nearly_all = 0.9;
    const double lies = std::min(std::max(beside, 0.0), height),
                 sunk = support + height - out.center[2];
    if (out.stopped && sunk >= nearly_all * (height - lies)) {
        out.stopped = false;
        out.by = -1;
        return out;
    }
    if (!out.stopped) out.center[2] -= way.drop_m;
    return out;
}

// How far an object reaches from its centre of mass: along its way, to the left of it, and
// to the right; or all around where it may go any way.
struct Reach {
    double ahead = 0, left = 0, right = 0, around = 0;
};
Table<ObjectId, Reach> reaches(const SolidScene& solids, const ObjectStage& objects,
                               TableView<ObjectId, Way> ways) {
    Table<ObjectId, Reach> out(objects.objects.size());
    const SolidCells& cells = solids.cells();
    const ObjectOf object_of(objects.object_of_primitive);
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const ObjectId o = object_of(cells.primitive[c]);
        if (o < 0) continue;
        const Body& object = objects.objects[o];
        if (object.grounded) continue;
        const Vec3 &center = object.candidate.body.center, &way = ways[o].direction;
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

safety::FallZone zone(const Body& from, const Way& way, const physics::Swept& swept,
                      const Reach& reach) {
    const Vec3& center = from.candidate.body.center;
    const double support = support_m(from), height = from.highest_m - from.lowest_m;
    safety::FallZone out;
    out.from = center;
    out.way = way.direction;
    out.left_m = reach.left;
    out.right_m = reach.right;
    out.lowest_m = std::min(support, from.lowest_m) - way.drop_m;
    out.highest_m = from.highest_m;
    const double on = std::hypot(swept.center[0] - center[0], swept.center[1] - center[1]);
    const bool lies_down = !way.slides && (swept.stopped || !(way.drop_m > 0));
    const double beyond =
        lies_down ? from.highest_m - center[2] : std::max(reach.ahead, height / 2);
    out.ahead_m = on + std::max(beyond, 0.0);
    if (way.direction == Vec3{}) out.ahead_m = std::max(reach.around, height / 2);
    return out;
}

double hits_J(const Body& from, const Way& way, const physics::Swept& swept) {
    if (!swept.stopped) return way.release_J;
    const physics::MassProperties& body = from.candidate.body;
    const double sinks_m = body.center[2] - swept.center[2];
    return std::clamp(way.barrier_J + body.mass_kg * physics::gravity * sinks_m, 0.0,
                      way.release_J);
}

}  // namespace

std::vector<Landing> landings(const SolidParts& parts, const ObjectStage& objects) {
    std::vector<Way> ways;
    for (const Body& from : objects.objects)
        ways.push_back(from.grounded ? Way{} : falling_way(from));
    const Table<ObjectId, Reach> reach = reaches(*parts.solids, objects, ways);
    const Stops stops(objects);
    std::vector<Landing> out(objects.objects.size());
    const std::vector<std::vector<std::int32_t>> taken = taken_along(objects);
    for (std::size_t o = 0; o < out.size(); ++o) {
        const Body& from = objects.objects[o];
        if (from.grounded) continue;
        out[o].takes_along = taken[o];
        std::vector<std::int32_t> along;  // primitives
        for (const std::int32_t x : taken[o]) {
            const auto& of = objects.objects[x].candidate.primitives;
            along.insert(along.end(), of.begin(), of.end());
        }
        std::ranges::sort(along);
        out[o].swept = swept(parts, objects.hidden_walls, from, ways[o], along);
        out[o].drop_m = ways[o].drop_m;
        out[o].on_easiest = ways[o].easiest;
        const physics::Candidate& body = from.candidate;
        const std::vector<bool> stopping = stops.of(body.primitives, body.body.mass_kg);
        out[o].easiest = ways[o].easiest ? out[o].swept
                                         : swept(parts, objects.hidden_walls, from,
                                                 easiest_way(from), along, stopping);
        out[o].for_good =
            out[o].easiest.stopped && out[o].easiest.by >= 0 && stopping[out[o].easiest.by];
        out[o].hits_J = hits_J(from, ways[o], out[o].swept);
        out[o].zone = zone(from, ways[o], out[o].swept, reach[o]);
    }
    return out;
}

}  // namespace topple
