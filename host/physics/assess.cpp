// SPDX-License-Identifier: MIT
#include "physics/assess.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "physics/tipping.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

// The body turns so that d becomes vertical; its own vertical then leans to the other side of d.
Vec3 lean(const Vec3& d) {
    const double length = std::sqrt(d[0] * d[0] + d[1] * d[1]);
    if (!(length > 1e-6)) return {};
    return {-d[0] / length, -d[1] / length, 0};
}

// Of what stood: any small thing is round to within a voxel, so that more than that must tell that
// it rolls.
constexpr double least_round = 0.125;  // of the height of its centre of mass

// The hull's landscape about the pose as scanned.
struct Surroundings {
    const HullWays* ways = nullptr;  // none of what hangs
    double base_m = 0;               // the start's height
    double noise_m = 0;
    std::vector<PosePass> passes;
    bool rolls = false;

    // The level of a way from the start to there, if it lies behind a pass.
    std::optional<double> behind(const Vec3& up) const {
        if (!ways) return std::nullopt;
        const double level = ways->level(up);
        if (level - ways->height(up) <= noise_m) return std::nullopt;
        return level;
    }
    bool is_deeper(double height_m) const { return height_m < base_m - noise_m / 2; }
};

Surroundings surroundings(const StandingHull& hull, const Candidate& candidate) {
    constexpr double rounding = 1e-7;  // of the radius
    const double noise = hull.resolution_m + rounding * hull.ways->hull().radius;
    const bool stood = candidate.stood && is_held(candidate);
    const double height = candidate.body.center[2] - candidate.support_height_m;
    // What hangs from above its centre of mass has no hull to turn on.
    if (stood && height <= 0) return {nullptr, height, noise, {}, false};
    const HullWays& ways = *hull.ways;
    const double round = stood ? std::min(noise, least_round * ways.start_height()) : noise;
    return {&ways, ways.start_height(), noise, ways.passes(noise), ways.rolls(round)};
}

// The deepest height that opens to a body leaning towards `way` (unit, horizontal): behind the
// first pass of the hull that this turn meets. The start's height if it meets none.
double deepest_towards(const Surroundings& around, const Vec3& way) {
    constexpr double step = 0.04, farthest = 2.1;  // radians
    for (double angle = 0; angle < farthest; angle += step) {
        const double s = std::sin(angle), c = std::cos(angle);
        const auto level = around.behind({-s * way[0], -s * way[1], c});
        if (!level) continue;
        const auto after = std::ranges::upper_bound(around.passes, *level, {}, &PosePass::height_m);
        if (after != around.passes.begin()) return std::prev(after)->deepest_m;
    }
    return around.base_m;
}

// A pass that is the scanned pose itself leans nowhere: what matters is where it leads. Upside down
// all ways are as far.
Vec3 way_over(const PosePass& pass) {
    for (const Vec3& up : {pass.direction, pass.deepest}) {
        const Vec3 way = lean(up);
        if (way != Vec3{}) return way;
    }
    return {1, 0, 0};
}

void add_passes(const Candidate& candidate, const Surroundings& around,
                std::vector<TippingWay>& ways) {
    const double base = around.base_m;
    for (const PosePass& pass : around.passes) {
        TippingWay way{pass.height_m - base,
                       around.is_deeper(pass.deepest_m) ? pass.height_m - pass.deepest_m : 0,
                       way_over(pass)};
        if (pass.edge) {
            const Vec3& c = candidate.body.center;
            way.edge = Ends{along(c, 1, (*pass.edge)[0]), along(c, 1, (*pass.edge)[1])};
        }
        ways.push_back(way);
    }
}

void add_footing(const Candidate& candidate, const Footing& on, const Surroundings& around,
                 std::vector<TippingWay>& ways) {
    const double base = around.base_m;
    const std::vector<double>& drops = candidate.edge_drop_m;
    if (!drops.empty() && drops.size() != std::max<std::size_t>(on.edges.size(), 1)) {
        throw Error(ErrorKind::usage, "assess: a candidate has " + std::to_string(drops.size()) +
                                          " drops, but its support has " +
                                          std::to_string(on.edges.size()) + " edges to tip over");
    }
    const auto add = [&](double climb, const Vec3& way, std::size_t edge,
                         const std::array<std::array<double, 2>, 2>& ends) {
        const double deepest = deepest_towards(around, way);
        const double z = candidate.support_height_m;
        const double turn = around.is_deeper(deepest) ? base - deepest : 0;
        const double drop = drops.empty() ? 0 : drops[edge], descent = turn + drop;
        ways.push_back({climb, descent > 0 ? climb + descent : 0, way,
                        Ends{Vec3{ends[0][0], ends[0][1], z}, Vec3{ends[1][0], ends[1][1], z}},
                        drop});
    };
    if (on.edges.empty()) return add(0, on.away, 0, on.nearest);
    const double h = candidate.body.center[2] - candidate.support_height_m;
    for (std::size_t n = 0; n < on.edges.size(); ++n) {
        const Footing::Edge& edge = on.edges[n];
        add(std::sqrt(h * h + edge.distance_m * edge.distance_m) - h, edge.outward, n, edge.ends);
    }
}

// Held by nothing: it falls as its hull lets it.
void add_fall(const Surroundings& around, std::vector<TippingWay>& ways) {
    const double base = around.base_m;
    TippingWay fall;
    for (const PosePass& pass : around.passes) {
        if (pass.height_m > base + around.noise_m) break;
        if (around.is_deeper(pass.deepest_m)) {
            fall.release_m = base - pass.deepest_m;
            fall.direction = way_over(pass);
        }
    }
    ways.push_back(fall);
}

// The easiest way that releases anything, of equal ones the one that releases most: the first step
// of the curve. The lowest pass of all may lead nowhere deeper, and a body that rolls has no way.
std::optional<TippingWay> releasing(const std::vector<TippingWay>& ways) {
    std::optional<TippingWay> first;
    for (const TippingWay& way : ways) {
        if (!(way.release_m > 0)) continue;
        if (!first || way.climb_m < first->climb_m ||
            (way.climb_m == first->climb_m && way.release_m > first->release_m))
            first = way;
    }
    return first;
}

// S(W) of Eq. 6: the largest release over all ways with a climb of at most W.
std::vector<InstabilityStep> curve_of(std::vector<TippingWay> ways, double weight_N) {
    std::ranges::stable_sort(ways, {}, &TippingWay::climb_m);
    std::vector<InstabilityStep> curve;
    for (const TippingWay& way : ways) {
        const double W = weight_N * way.climb_m, S = weight_N * way.release_m;
        if (S <= (curve.empty() ? 0 : curve.back().S_J)) continue;
        if (!curve.empty() && curve.back().W_J == W) {
            curve.back().S_J = S;
        } else {
            curve.push_back({W, S});
        }
    }
    return curve;
}

}  // namespace

Stability assess(const StandingHull& hull, const Candidate& candidate) {
    if (!hull.ways) return {};
    constexpr double alike = 1e-6;  // of the radius
    const Surroundings around = surroundings(hull, candidate);
    const double radius = hull.ways->hull().radius;
    Stability result;
    std::vector<TippingWay> ways;
    if (candidate.support_polygon.empty()) {
        result.margin_m = -radius;
        add_fall(around, ways);
    } else {
        const Footing on =
            footing(candidate.support_polygon, candidate.body.center[0], candidate.body.center[1]);
        result.margin_m = on.margin_m;
        add_footing(candidate, on, around, ways);
    }
    add_passes(candidate, around, ways);
    if (around.rolls) ways.push_back({});
    weigh_ways(ways, candidate.body.mass_kg * gravity, alike * radius, result);
    result.ways = std::move(ways);
    return result;
}

void weigh_ways(const std::vector<TippingWay>& ways, double weight_N, double alike_m,
                Stability& result) {
    const auto least = std::ranges::min_element(ways, {}, &TippingWay::climb_m);
    // Of ways equal to within rounding, the one that releases most.
    const TippingWay* taken = &*least;
    for (const TippingWay& way : ways) {
        if (way.climb_m <= least->climb_m + alike_m && way.release_m > taken->release_m)
            taken = &way;
    }
    result.barrier_J = weight_N * least->climb_m;
    result.release_J = weight_N * taken->release_m;
    result.easiest = *taken;
    result.releasing = releasing(ways);
    result.curve = curve_of(ways, weight_N);
}

}  // namespace topple::physics
