// SPDX-License-Identifier: MIT
#include "physics/leaning.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vectors.h"
#include "physics/assess.h"
#include "physics/fall_sweep.h"
#include "physics/tipping.h"

namespace topple::physics {
namespace {

// Where something fixed stops the body on one way: how much higher it was over its edge, and
// whether it got as far.
struct Stop {
    double edge_climb_m = 0, release_m = 0;
};

}  // namespace

double footing_reach(const Candidate& candidate, const Vec3& way) {
    double most = 0;
    for (const auto& [x, y] : candidate.support_polygon) {
        const Vec3& c = candidate.body.center;
        most = std::max(most, dot({x - c[0], y - c[1], 0}, way));
    }
    return most;
}

std::optional<Stability> beside_fixed(const SolidCells& cells, const CellColumns& columns,
                                      const HiddenWalls& walls, const Candidate& body,
                                      const std::vector<bool>& fixed, double top_m,
                                      const Stability& open) {
    const Vec3& center = body.body.center;
    const double height = center[2] - body.support_height_m;
    if (body.support_polygon.empty() || !(height > 0)) return std::nullopt;
    const auto stop_on = [&](const Vec3& way) -> std::optional<Stop> {
        const double beside = footing_reach(body, way);
        // What is not fixed gives way until it, too, meets what is.
        const Swept swept = sweep_over_edge(cells, columns, walls, body, {}, body.support_height_m,
                                            way, beside, top_m, fixed);
        if (!swept.stopped) return std::nullopt;
        Stop stop{rise_over_edge_m(height, beside), 0};
        const double ahead =
            dot({swept.center[0] - center[0], swept.center[1] - center[1], 0}, way);
        if (ahead > beside)
            stop.release_m = std::max(0.0, stop.edge_climb_m + center[2] - swept.center[2]);
        return stop;
    };
    std::vector<std::pair<Vec3, std::optional<Stop>>> known;  // by way
    const auto stop_of = [&](const Vec3& way) {
        const auto found =
            std::ranges::find(known, way, &std::pair<Vec3, std::optional<Stop>>::first);
        if (found != known.end()) return found->second;
        known.emplace_back(way, stop_on(way));
        return known.back().second;
    };
    constexpr double alike = 1e-6;
    std::vector<TippingWay> ways = open.ways;
    bool any = false;
    for (TippingWay& way : ways) {
        if (way.direction == Vec3{} || !(way.release_m > 0)) continue;
        const auto stop = stop_of(way.direction);
        if (!stop) continue;
        const bool first = way.climb_m <= stop->edge_climb_m * (1 + alike) + alike;
        way.release_m = first ? std::min(way.release_m, stop->release_m) : 0;
        way.drop_m = 0;
        any = true;
    }
    if (!any) return std::nullopt;
    Stability out = open;
    weigh_ways(ways, body.body.mass_kg * gravity, alike * (top_m - body.support_height_m), out);
    out.ways = std::move(ways);
    return out;
}

}  // namespace topple::physics
