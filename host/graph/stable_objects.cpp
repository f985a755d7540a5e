// SPDX-License-Identifier: MIT
#include "graph/stable_objects.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "device/native/thread_pool.h"
#include "graph/group_energy.h"
#include "physics/tipping.h"

namespace topple::graph {
namespace {

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
                          const SolidCells& cells, const ContactGraph& graph,
                          std::span<const physics::Body> bodies, const SurfaceSeams& seams,
                          const std::vector<bool>& ground, const GroupingOptions& options) {
    const GroupEnergy energy(device, table, cells, graph, bodies, seams, ground, options);
    SwendsenWangOptions sampler;
    sampler.seed = options.seed;
    // Enough flips that every node is tried many times over all chains, within seconds.
    sampler.chains = 4;
    sampler.threads = device.threads().threads();
    sampler.last_temperature = 0.005;
    sampler.anneal_steps = static_cast<unsigned>(std::clamp<std::int64_t>(
        100 * graph.primitives, 2000, std::max<std::int64_t>(12000, 25 * graph.primitives)));
    sampler.sample_steps = sampler.anneal_steps / 2;
    sampler.time_limit_s = options.time_limit_s;
    sampler.cancelled = options.cancelled;
    const std::vector<Edge> edges = edges_of(graph, energy.prior(), options.turn_on_temperature);
    Partition partition =
        swendsen_wang_cuts(graph.primitives, edges, ground, energy.callbacks(), sampler);
    return {std::move(partition.label), std::move(partition.joined), std::move(partition.agreement),
            std::move(partition.best_energy_curve)};
}

}  // namespace topple::graph
