// SPDX-License-Identifier: MIT
#include "physics/assess.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "physics/pose_passes.h"
#include "physics/standing_hull.h"
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

// The direction of the mesh nearest to d, by ascent from v.
std::uint32_t nearest(const SphereMesh& mesh, std::uint32_t v, const Vec3& d) {
    const auto along = [&](std::uint32_t w) {
        return mesh.x[w] * d[0] + mesh.y[w] * d[1] + mesh.z[w] * d[2];
    };
    for (double most = along(v);;) {
        std::uint32_t best = v;
        for (std::size_t k = 0; k < 6; ++k) {
            const std::uint32_t w = mesh.neighbour[std::size_t{v} * 6 + k];
            if (const double reach = along(w); reach > most) {
                most = reach;
                best = w;
            }
        }
        if (best == v) return v;
        v = best;
    }
}

// Of positive values. Several maxima side by side: none waits for the one before it.
float highest(std::span<const float> height) {
    std::array<float, 16> most{};
    std::size_t v = 0;
    for (; v + most.size() <= height.size(); v += most.size()) {
        for (std::size_t k = 0; k < most.size(); ++k) most[k] = std::max(most[k], height[v + k]);
    }
    for (; v < height.size(); ++v) most[0] = std::max(most[0], height[v]);
    return *std::max_element(most.begin(), most.end());
}

// A pass at the level at which the landscape has it, and made exact.
struct Opening {
    double level_m = 0;
    PosePass pass;
};

// The direction to start from. It is direction 0, the pose as scanned, but for a candidate whose
// footing holds it: contacts are known to a voxel or two, so that its hull may seem to rock by an
// angle within that; then it is the bottom of that dent.
std::uint32_t start_direction(const SupportTable::Rows& rows, const Candidate& candidate,
                              std::span<const float> height) {
    const std::optional<double> angle = dent_angle(rows, candidate);
    if (!angle) return 0;
    std::uint32_t v = 0;
    for (bool lower = true; lower;) {
        std::uint32_t best = v;
        for (std::size_t k = 0; k < 6; ++k) {
            const std::uint32_t w = rows.mesh.neighbour[std::size_t{v} * 6 + k];
            if (height[w] < height[best]) best = w;
        }
        lower = best != v;
        v = best;
    }
    return is_dent(rows, *angle, direction_of(rows.mesh, v), height[0] - height[v]) ? v : 0;
}

template <typename Refine>
std::vector<Opening> openings(const std::vector<PosePass>& passes, const Refine& refine) {
    std::vector<Opening> result;
    for (const PosePass& found : passes) result.push_back({found.height_m, refine(found)});
    return result;
}

// What the mesh found, made exact by the vertices nearby.
PosePass refined(const PosePass& found, const Sampled& f, std::span<const Vec3> vertices) {
    const double base = f.height[f.start];
    PosePass pass = found;
    if (found.height_m > base) {
        if (const auto exact = refine_pass(found, vertices, f.spacing)) pass = *exact;
        pass.height_m = std::max(pass.height_m, base);
    }
    pass.deepest_m = refine_minimum(found.deepest, vertices, f.spacing);
    return pass;
}

// The landscape's passes, and the level of a way from the start to a direction that lies behind one
// of them.
struct Surroundings {
    double base_m = 0;  // the start's height
    std::vector<Opening> passes;
    std::function<std::optional<double>(const Vec3& up)> behind;
    bool rolls = false;
};

Surroundings sampled_surroundings(const Sampled& f, std::span<const Vec3> vertices) {
    return {f.height[f.start],
            openings(find_passes(f), [&](const PosePass& p) { return refined(p, f, vertices); }),
            [&f, v = 0U](const Vec3& up) mutable -> std::optional<double> {
                v = nearest(*f.mesh, v, up);
                const double level = f.basins->level(v);
                if (level - f.height[v] <= f.noise_m) return std::nullopt;
                return level;
            },
            rolls(f)};
}

// Of what stood: any small thing is round to within a voxel, so that more than that must tell that
// it rolls.
constexpr double least_round = 0.125;  // of the height of its centre of mass

std::optional<Surroundings> exact_surroundings(const SupportTable::Rows& rows,
                                               const Candidate& candidate, double noise) {
    const bool stood = candidate.stood && is_held(candidate);
    const double height = candidate.body.center[2] - candidate.support_height_m;
    // What hangs from above its centre of mass has no hull to turn on.
    if (stood && height <= 0)
        return Surroundings{height, {}, [](const Vec3&) { return std::nullopt; }, false};
    const std::shared_ptr<const HullWays> ways = standing_hull(rows, candidate);
    if (!ways) return std::nullopt;
    const bool rolls =
        ways->rolls(stood ? std::min(noise, least_round * ways->start_height()) : noise);
    return Surroundings{
        ways->start_height(),
        openings(passes_that_matter(ways->passes(noise)), [](const PosePass& p) { return p; }),
        [ways, noise](const Vec3& up) -> std::optional<double> {
            const double level = ways->level(up);
            if (level - ways->height(up) <= noise) return std::nullopt;
            return level;
        },
        rolls};
}

bool is_deeper(const Sampled& f, double base, double height) {
    return height < base - f.resolution_m / 2;
}

// The deepest height that opens to a body leaning towards `way` (unit, horizontal): behind the
// first pass of the hull that this turn meets. The start's height if it meets none within 120
// degrees.
double deepest_towards(const Sampled& f, const Surroundings& around, const Vec3& way) {
    const double step = f.spacing / 2;
    for (double angle = 0; angle < 2.1; angle += step) {
        const double s = std::sin(angle), c = std::cos(angle);
        const auto level = around.behind({-s * way[0], -s * way[1], c});
        if (!level) continue;
        const auto after =
            std::upper_bound(around.passes.begin(), around.passes.end(), *level,
                             [](double height, const Opening& p) { return height < p.level_m; });
        if (after != around.passes.begin()) return std::prev(after)->pass.deepest_m;
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

void add_passes(const Candidate& candidate, const Sampled& f, const Surroundings& around,
                std::vector<TippingWay>& ways) {
    const double base = around.base_m;
    for (const auto& [level, pass] : around.passes) {
        TippingWay way{pass.height_m - base,
                       is_deeper(f, base, pass.deepest_m) ? pass.height_m - pass.deepest_m : 0,
                       way_over(pass)};
        if (pass.edge) {
            const Vec3& c = candidate.body.center;
            way.edge = Ends{along(c, 1, (*pass.edge)[0]), along(c, 1, (*pass.edge)[1])};
        }
        ways.push_back(way);
    }
}

void add_footing(const Candidate& candidate, const Footing& on, const Sampled& f,
                 const Surroundings& around, std::vector<TippingWay>& ways) {
    const double base = around.base_m;
    const std::vector<double>& drops = candidate.edge_drop_m;
    if (!drops.empty() && drops.size() != std::max<std::size_t>(on.edges.size(), 1)) {
        throw Error(ErrorKind::usage, "evaluate: a candidate has " + std::to_string(drops.size()) +
                                          " drops, but its support has " +
                                          std::to_string(on.edges.size()) + " edges to tip over");
    }
    const auto add = [&](double climb, const Vec3& way, std::size_t edge,
                         const std::array<std::array<double, 2>, 2>& ends) {
        const double deepest = deepest_towards(f, around, way);
        const double z = candidate.support_height_m;
        const double turn = is_deeper(f, base, deepest) ? base - deepest : 0;
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
void add_fall(const Sampled& f, const Surroundings& around, std::vector<TippingWay>& ways) {
    const double base = around.base_m;
    TippingWay fall;
    for (const auto& [level, pass] : around.passes) {
        if (pass.height_m > base + f.resolution_m) break;
        if (is_deeper(f, base, pass.deepest_m)) {
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

Stability assess(const SupportTable::Rows& rows, const Candidate& candidate,
                 std::span<const float> height, std::span<std::uint32_t> down, Passes passes) {
    const std::uint32_t start = start_direction(rows, candidate, height);
    const Basins basins(height, rows.mesh, down, start);
    const double radius = highest(height);
    const double weight_N = candidate.body.mass_kg * gravity;
    // Heights are known to a voxel, and to the rounding of their float sums.
    const double resolution = rows.resolution_m + 1e-5 * radius;
    const Sampled f{&rows.mesh,
                    height,
                    &basins,
                    start,
                    rows.spacing,
                    resolution,
                    resolution + rows.spacing / 2 * radius};
    std::optional<Surroundings> found;
    if (passes == Passes::exact)
        found = exact_surroundings(rows, candidate, rows.resolution_m + 1e-7 * radius);
    const Surroundings around =
        found ? std::move(*found) : sampled_surroundings(f, vertices_of(rows, candidate));

    Stability result;
    std::vector<TippingWay> ways;
    if (candidate.support_polygon.empty()) {
        result.margin_m = -radius;
        add_fall(f, around, ways);
    } else {
        const Footing on =
            footing(candidate.support_polygon, candidate.body.center[0], candidate.body.center[1]);
        result.margin_m = on.margin_m;
        add_footing(candidate, on, f, around, ways);
    }
    add_passes(candidate, f, around, ways);
    if (around.rolls) ways.push_back({});
    weigh_ways(ways, weight_N, 1e-6 * radius, result);
    if (passes == Passes::exact) result.ways = std::move(ways);
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
