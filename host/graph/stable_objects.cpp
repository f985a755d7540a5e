// SPDX-License-Identifier: MIT
#include "graph/stable_objects.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "device/native/thread_pool.h"
#include "graph/swendsen_wang.h"
#include "physics/drop.h"
#include "physics/tipping.h"

namespace topple::graph {
namespace {

constexpr double pi = std::numbers::pi;

// S(O, W) of Eq. 6 at the energy W: the largest release that W sets free.
double release_at(const physics::Stability& stability, double work_J) {
    double release = 0;
    for (const InstabilityStep& step : stability.curve) {
        if (step.W_J <= work_J) release = std::max(release, step.S_J);
    }
    return release;
}

// Eq. 10, with the freedom that the joint takes as the feature F.
std::vector<Edge> edges_of(const ContactGraph& graph, const ScenePrior& prior, double temperature) {
    std::vector<Edge> edges;
    edges.reserve(graph.pairs.size());
    for (const physics::TouchingPair& pair : graph.pairs) {
        const double f = prior.lost_between(pair.a, pair.b);
        edges.push_back({pair.a, pair.b, std::clamp(std::exp(-f / temperature), 0.05, 0.95)});
    }
    return edges;
}

// Whether a body withstands a tilt of its support: S = 0 without a look at its landscape. The
// height that tilting by an angle a lifts the centre of mass by is h (1 / cos a - 1), and an edge
// at the distance m asks for sqrt(h^2 + m^2) - h: the one is less than the other where m > h tan a.
// slack_m: what the outline of the support, made of whole voxels, is too wide by.
bool stands(const physics::Candidate& c, double tilt, double slack_m) {
    if (c.support_polygon.empty()) return false;
    const physics::Footing foot =
        physics::footing(c.support_polygon, c.body.center[0], c.body.center[1]);
    const double height = c.body.center[2] - c.support_height_m;
    return foot.margin_m > slack_m && foot.margin_m - slack_m >= height * std::tan(tilt);
}

}  // namespace

physics::Candidate candidate_of(const ContactGraph& graph, std::span<const physics::Body> bodies,
                                const std::vector<bool>& ground,
                                std::vector<std::int32_t> primitives) {
    physics::Candidate candidate;
    std::sort(primitives.begin(), primitives.end());
    std::vector<physics::Body> parts;
    for (const std::int32_t p : primitives) parts.push_back(bodies[static_cast<std::size_t>(p)]);
    candidate.body = physics::combine(parts);
    std::vector<std::array<double, 2>> points;
    candidate.support_height_m = std::numeric_limits<double>::infinity();
    for (const std::int32_t p : primitives) {
        for (const Carrying& c : graph.carriers_of(p)) {
            if (std::binary_search(primitives.begin(), primitives.end(), c.supporter)) continue;
            points.insert(points.end(), c.outline.begin(), c.outline.end());
            candidate.support_height_m = std::min(candidate.support_height_m, c.height_m);
        }
    }
    if (points.empty()) candidate.support_height_m = 0;
    for (const std::int32_t p : primitives) {
        if (points.empty()) break;
        for (const Leaning& l : graph.leanings_of(p)) {
            if (!ground[static_cast<std::size_t>(l.against)]) continue;
            if (l.height_m < candidate.body.center[2]) continue;
            if (std::binary_search(primitives.begin(), primitives.end(), l.against)) continue;
            points.insert(points.end(), l.outline.begin(), l.outline.end());
        }
    }
    if (!points.empty()) candidate.support_polygon = physics::convex_polygon(points);
    candidate.primitives = std::move(primitives);
    return candidate;
}

double free_fall_m(const ContactGraph& graph, std::span<const std::int32_t> primitives) {
    // A scrap under one corner does not stop a fall.
    constexpr double least_share = 0.15;  // of the body, seen from below
    std::vector<Clearance> under;
    double lowest = std::numeric_limits<double>::infinity(), area = 0;
    for (const std::int32_t p : primitives) {
        lowest = std::min(lowest, graph.lowest_m[static_cast<std::size_t>(p)]);
        area += graph.silhouette_m2[static_cast<std::size_t>(p)][2];
        for (const Clearance& c : graph.clearances[static_cast<std::size_t>(p)]) {
            if (std::find(primitives.begin(), primitives.end(), c.below) == primitives.end())
                under.push_back(c);
        }
    }
    std::ranges::sort(under, {}, &Clearance::gap_m);
    double met = 0;
    for (const Clearance& c : under) {
        met += c.area_m2;
        if (met >= least_share * area) return c.gap_m;
    }
    // Nothing was seen below: down to the lowest thing in the scene.
    double floor = std::numeric_limits<double>::infinity();
    for (const double z : graph.lowest_m) floor = std::min(floor, z);
    return std::isfinite(lowest - floor) ? lowest - floor : 0;
}

Grouping group_primitives(device::Device& device, const physics::SupportTable& table,
                          const physics::SolidCells& cells, const ContactGraph& graph,
                          std::span<const physics::Body> bodies, const SurfaceSeams& seams,
                          const std::vector<bool>& ground, const GroupingOptions& options) {
    const ScenePrior prior(graph, bodies, seams, ground, options.prior);
    const physics::CellColumns columns(cells);
    const double tilt = options.tilt_deg * pi / 180;
    // The body that a query asks about, if it does not stand.
    const auto unstable_body = [&](const GroupQuery& query) -> std::optional<physics::Candidate> {
        if (query.pinned) return std::nullopt;  // the ground does not fall: S = 0
        physics::Candidate c = candidate_of(graph, bodies, ground, query.nodes);
        if (c.body.mass_kg <= 0 || stands(c, tilt, 0.5 * cells.voxel_m)) return std::nullopt;
        return c;
    };
    const auto fall_m = [&](const physics::Candidate& c) {
        return c.support_polygon.empty() ? free_fall_m(graph, c.primitives)
                                         : physics::drop_when_tipped_m(cells, columns, c);
    };
    const auto instability = [&](double released_m) {
        return std::min(options.worst_instability, released_m / options.scale_m);
    };
    const auto energies = [&](std::span<const GroupQuery> queries, std::span<double> out) {
        std::vector<physics::Candidate> unstable;
        std::vector<std::size_t> query;  // of each candidate
        for (std::size_t i = 0; i < queries.size(); ++i) {
            out[i] = prior(queries[i].nodes);
            if (std::optional<physics::Candidate> c = unstable_body(queries[i])) {
                unstable.push_back(*std::move(c));
                query.push_back(i);
            }
        }
        const std::vector<physics::Stability> stability =
            physics::evaluate(device, table, unstable);
        for (std::size_t n = 0; n < unstable.size(); ++n) {
            const physics::Candidate& c = unstable[n];
            const double weight = c.body.mass_kg * physics::gravity;
            const double height = std::max(c.body.center[2] - c.support_height_m, 0.0);
            // What does not stand by stands() falls, whatever its barrier.
            const double release =
                std::max(release_at(stability[n], weight * height * (1 / std::cos(tilt) - 1)),
                         stability[n].release_J);
            out[query[n]] += instability(release / weight + fall_m(c));
        }
    };
    // Instability is never below 0, nor below what the fall alone makes.
    const auto prior_alone = [&](const GroupQuery& query, double) { return prior(query.nodes); };
    const auto prior_and_fall = [&](const GroupQuery& query, double prior_of_it) {
        const std::optional<physics::Candidate> c = unstable_body(query);
        return c ? prior_of_it + instability(fall_m(*c)) : prior_of_it;
    };
    SwendsenWangOptions sampler;
    sampler.seed = options.seed;
    // Enough flips that every node is tried many times over all chains, within seconds.
    sampler.chains = 4;
    sampler.threads = device.threads().threads();
    sampler.last_temperature = 0.005;
    sampler.anneal_steps =
        static_cast<unsigned>(std::clamp<std::int64_t>(100 * graph.primitives, 2000, 12000));
    sampler.sample_steps = sampler.anneal_steps / 2;
    sampler.time_limit_s = options.time_limit_s;
    sampler.cancelled = options.cancelled;
    const std::vector<Edge> edges = edges_of(graph, prior, options.turn_on_temperature);
    Partition partition = swendsen_wang_cuts(graph.primitives, edges, ground,
                                             {energies, {prior_alone, prior_and_fall}}, sampler);
    return {std::move(partition.label), std::move(partition.joined),
            std::move(partition.best_energy_curve)};
}

}  // namespace topple::graph
