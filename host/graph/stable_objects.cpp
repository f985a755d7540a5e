// SPDX-License-Identifier: MIT
#include "graph/stable_objects.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "graph/swendsen_wang.h"
#include "physics/tipping.h"

namespace topple::graph {
namespace {

// S(O, W) of Eq. 6 at the energy W: the largest release that W sets free.
double release_at(const physics::Stability& stability, double work_J) {
    double release = 0;
    for (const InstabilityStep& step : stability.curve) {
        if (step.W_J <= work_J) release = std::max(release, step.S_J);
    }
    return release;
}

// The larger of the two faces that could take part in a contact, seen along its normal.
double larger_face(const ContactGraph& graph, const physics::TouchingPair& pair) {
    std::size_t axis = 0;
    for (std::size_t d = 1; d < 3; ++d) {
        if (std::abs(pair.normal[d]) > std::abs(pair.normal[axis])) axis = d;
    }
    return std::max(graph.silhouette_m2[static_cast<std::size_t>(pair.a)][axis],
                    graph.silhouette_m2[static_cast<std::size_t>(pair.b)][axis]);
}

std::vector<Edge> edges_of(const ContactGraph& graph, double temperature) {
    std::vector<Edge> edges;
    edges.reserve(graph.pairs.size());
    for (const physics::TouchingPair& pair : graph.pairs) {
        const double face = larger_face(graph, pair);
        const double f = face > 0 ? 1 - std::min(1.0, pair.area_m2 / face) : 1;  // Eq. 10
        edges.push_back({pair.a, pair.b, std::clamp(std::exp(-f / temperature), 0.05, 0.95)});
    }
    return edges;
}

}  // namespace

physics::Candidate candidate_of(const ContactGraph& graph, std::span<const physics::Body> bodies,
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
    if (!points.empty()) candidate.support_polygon = physics::convex_polygon(points);
    candidate.primitives = std::move(primitives);
    return candidate;
}

double free_fall_m(const ContactGraph& graph, std::span<const std::int32_t> primitives) {
    double lowest = std::numeric_limits<double>::infinity(),
           fall = std::numeric_limits<double>::infinity();
    for (const std::int32_t p : primitives) {
        lowest = std::min(lowest, graph.lowest_m[static_cast<std::size_t>(p)]);
        for (const Clearance& c : graph.clearances[static_cast<std::size_t>(p)]) {
            const bool own =
                std::find(primitives.begin(), primitives.end(), c.below) != primitives.end();
            if (!own) fall = std::min(fall, c.gap_m);
        }
    }
    if (std::isfinite(fall)) return fall;
    // Nothing was seen below: down to the lowest thing in the scene.
    double floor = std::numeric_limits<double>::infinity();
    for (const double z : graph.lowest_m) floor = std::min(floor, z);
    return std::isfinite(lowest - floor) ? lowest - floor : 0;
}

Grouping group_primitives(device::Device& device, const physics::SupportTable& table,
                          const ContactGraph& graph, std::span<const physics::Body> bodies,
                          const NormalVariation& variation, const std::vector<bool>& ground,
                          const GroupingOptions& options) {
    const ScenePrior prior(graph, bodies, variation, ground, options.prior);
    const GroupEnergies energies = [&](std::span<const GroupQuery> queries, std::span<double> out) {
        std::vector<physics::Candidate> candidates;
        for (const GroupQuery& q : queries) {
            if (!q.pinned) candidates.push_back(candidate_of(graph, bodies, q.nodes));
        }
        const std::vector<physics::Stability> stability =
            physics::evaluate(device, table, candidates);
        std::size_t next = 0;
        for (std::size_t i = 0; i < queries.size(); ++i) {
            out[i] = prior(queries[i].nodes);
            if (queries[i].pinned) continue;  // the ground does not fall: S = 0
            const physics::Candidate& c = candidates[next];
            const physics::Stability& s = stability[next++];
            const double weight = c.body.mass_kg * physics::gravity;
            if (weight <= 0) continue;
            double release = release_at(s, weight * options.disturbance_m);
            if (c.support_polygon.empty()) release += weight * free_fall_m(graph, c.primitives);
            out[i] += std::min(options.worst_instability, release / (weight * options.scale_m));
        }
    };
    SwendsenWangOptions sampler;
    sampler.seed = options.seed;
    // Enough flips that every node is tried many times over all chains, within seconds.
    sampler.chains = 4;
    sampler.anneal_steps =
        static_cast<unsigned>(std::clamp<std::int64_t>(10 * graph.primitives, 500, 5000));
    sampler.sample_steps = sampler.anneal_steps / 2;
    sampler.cancelled = options.cancelled;
    const std::vector<Edge> edges = edges_of(graph, options.turn_on_temperature);
    Partition partition = swendsen_wang_cuts(graph.primitives, edges, ground, energies, sampler);
    return {std::move(partition.label), std::move(partition.joined),
            std::move(partition.best_energy_curve)};
}

}  // namespace topple::graph
