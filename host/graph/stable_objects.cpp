// SPDX-License-Identifier: MIT
#include "graph/stable_objects.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "fitted/boosted_trees.h"
#include "graph/greedy_contraction.h"
#include "graph/group_energy.h"
#include "graph/outline.h"
#include "solids/cell_shape.h"

namespace topple::graph {
namespace {

// Eq. 10 as Barbu and Zhu mean it: an edge is on with the probability that its ends are one.
std::vector<Edge> edges_of(std::span<const Joint> joints) {
    std::vector<Edge> edges;
    edges.reserve(joints.size());
    for (const Joint& j : joints)
        edges.push_back({j.a, j.b, std::clamp(fitted::probability(j.log_odds), 0.02, 0.98)});
    return edges;
}

// Each group has the number of the one that most of its primitives were in, if no other has more of
// that one's; the others have new ones.
void keep_numbers(const Table<PrimitiveId, std::int32_t>& before,
                  Table<PrimitiveId, std::int32_t>& group) {
    std::map<std::pair<std::int32_t, std::int32_t>, int> common;  // of number before and group
    std::int32_t next = 0;
    for (std::size_t p = 0; p < group.size(); ++p) {
        next = std::max(next, before[p] + 1);
        if (group[p] >= 0 && before[p] >= 0) ++common[{before[p], group[p]}];
    }
    std::vector<std::tuple<int, std::int32_t, std::int32_t>> offers;  // the largest first
    for (const auto& [pair, count] : common) offers.emplace_back(-count, pair.first, pair.second);
    std::ranges::sort(offers);
    std::map<std::int32_t, std::int32_t> number_of{{-1, -1}};
    std::set<std::int32_t> given;
    for (const auto& [count, number, of] : offers)
        if (!number_of.contains(of) && given.insert(number).second) number_of[of] = number;
    for (std::int32_t& g : group) {
        const auto [at, fresh] = number_of.try_emplace(g, next);
        next += static_cast<std::int32_t>(fresh);
        g = at->second;
    }
    close_gaps(group);
}

}  // namespace

void close_gaps(Table<PrimitiveId, std::int32_t>& group) {
    std::set<std::int32_t> numbers(group.begin(), group.end());
    numbers.erase(-1);
    std::map<std::int32_t, std::int32_t> instead;
    for (std::int32_t n = 0; !numbers.empty() && n < *numbers.rbegin(); ++n) {
        if (numbers.contains(n)) continue;
        const std::int32_t last = *numbers.rbegin();
        instead[last] = n;
        numbers.erase(last);
        numbers.insert(n);
    }
    for (std::int32_t& g : group)
        if (const auto at = instead.find(g); at != instead.end()) g = at->second;
}

physics::Candidate candidate_of(const ContactGraph& graph,
                                TableView<PrimitiveId, physics::MassProperties> bodies,
                                const Table<PrimitiveId, bool>& shell,
                                std::vector<std::int32_t> primitives) {
    physics::Candidate candidate;
    std::sort(primitives.begin(), primitives.end());
    std::vector<physics::MassProperties> parts;
    for (const std::int32_t p : primitives) parts.push_back(bodies[p]);
    candidate.body = physics::combine(parts);
    std::vector<BorderPoint> points;
    candidate.support_height_m = std::numeric_limits<double>::infinity();
    for (const std::int32_t p : primitives) {
        for (const Carrying& c : graph.carriers_of(p)) {
            if (std::binary_search(primitives.begin(), primitives.end(), c.supporter)) continue;
            add_points(c.outline, c.border_error_m, points);
            candidate.support_height_m = std::min(candidate.support_height_m, c.height_m);
        }
    }
    if (points.empty()) candidate.support_height_m = 0;
    for (const std::int32_t p : primitives) {
        if (points.empty()) break;
        for (const Leaning& l : graph.leanings_of(p)) {
            if (!shell[l.against]) continue;
            if (l.height_m < candidate.body.center[2]) continue;
            if (std::binary_search(primitives.begin(), primitives.end(), l.against)) continue;
            for (const auto& at : l.outline)
                points.push_back({at, solids::voxel_error * graph.voxel_m});
        }
    }
    if (!points.empty()) {
        Outline outline = outline_of(points);
        candidate.support_polygon = std::move(outline.polygon);
        candidate.border_error_m = outline.error_m;
    }
    candidate.primitives = std::move(primitives);
    return candidate;
}

Grouping group_primitives(device::Device& device, const ContactGraph& graph,
                          TableView<PrimitiveId, physics::MassProperties> bodies,
                          std::span<const Joint> joints, const ShellOdds& shell,
                          const GroupingOptions& options) {
    const std::vector<Joint> biased = biased_joints(joints, options.joint_bias);
    GroupEnergy energy(device, graph, bodies, biased, shell, options.standing_weight,
                       options.stability_level);
    std::optional<KeptGrouping> kept;
    if (!options.before.empty()) kept.emplace(options.links, options.before, biased, shell.pinned);
    // What is one object for sure is one node.
    const LinkedNodes nodes(graph.primitives, kept ? kept->links() : options.links);
    const auto joints_by = [&](double bias) {
        const std::vector<Joint> all = biased_joints(joints, bias);
        return nodes.joints(kept ? kept->of_open(all) : all);
    };
    const std::vector<Joint> joints_of_nodes = joints_by(options.joint_bias);
    const std::vector<bool> pinned = nodes.pinned(shell.pinned);
    SwendsenWangOptions sampler;
    sampler.seed = options.seed;
    sampler.chains = 8;
    sampler.threads = &device.threads();
    sampler.apart = nodes.apart();
    // Independent starts, by the joints with more and less of a bias.
    for (const double doubt : {0.0, 1.0, -1.0})
        sampler.starts.push_back(contract_greedily(nodes.size(),
                                                   joints_by(options.joint_bias - doubt), pinned,
                                                   nodes.sums(shell.log_odds), sampler.apart));
    sampler.starts.emplace_back();  // each node on its own
    // The first is near the best: what is left is to weigh how things stand, and to look whether a
    // few parts are better elsewhere.
    sampler.first_temperature = 0.5;
    sampler.last_temperature = 0.02;
    sampler.anneal_steps =
        static_cast<unsigned>(std::clamp<std::int64_t>(5 * nodes.size(), 1000, 50'000));
    sampler.time_limit_s = options.time_limit_s;
    sampler.cancelled = options.cancelled;
    Partition partition = swendsen_wang_cuts(nodes.size(), edges_of(joints_of_nodes), pinned,
                                             nodes.energies(energy.callbacks()), sampler);
    Grouping out;
    out.group = nodes.of_primitives(partition.label);
    if (kept) keep_numbers(options.before, out.group);
    out.energy_curve = std::move(partition.best_energy_curve);
    return out;
}

std::vector<double> pair_probabilities(const ContactGraph& graph, std::span<const Joint> joints,
                                       const ShellOdds& shell, const KnownLinks& links) {
    const LinkedNodes nodes(graph.primitives, links);
    std::vector<double> out;
    for (const physics::TouchingPair& pair : graph.pairs) {
        const auto at =
            std::ranges::lower_bound(joints, std::pair(pair.a, pair.b), {},
                                     [](const Joint& j) { return std::pair(j.a, j.b); });
        const bool known = at != joints.end() && at->a == pair.a && at->b == pair.b;
        // All of the room is one.
        const auto room = [&](std::int32_t p) { return fitted::probability(shell.log_odds[p]); };
        const double both = room(pair.a) * room(pair.b);
        const double joint = known ? fitted::probability(at->log_odds) : 0;
        const std::optional<bool> one = nodes.one_object(pair.a, pair.b);
        out.push_back(one ? (*one ? 1.0 : 0.0) : both + (1 - both) * joint);
    }
    return out;
}

}  // namespace topple::graph
