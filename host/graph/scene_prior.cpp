// SPDX-License-Identifier: MIT
#include "graph/scene_prior.h"

#include <algorithm>
#include <cmath>

namespace topple::graph {
namespace {

bool has(const Group& group, std::int32_t node) {
    return std::binary_search(group.begin(), group.end(), node);
}

// The freedom of a part on a face of `face_m2` that fixing it there by a joint of `joint_m2` takes:
// the ratio of the paper on a logarithmic scale, from 0 for all of the face to 1 for a
// thousandth of it, so that a faint joint is worse than a poor one.
double lost_freedom(double face_m2, double joint_m2) {
    constexpr double decades = 3;
    if (joint_m2 <= 0) return 1;
    return std::clamp(std::log10(face_m2 / joint_m2) / decades, 0.0, 1.0);
}

// Furniture stands against walls without being fixed to them: the least freedom that doing so
// would take.
constexpr double beside_shell = 0.5;

template <class Joint>
const Joint* find(const std::vector<Joint>& joints, std::int32_t other) {
    const auto at = std::ranges::find(joints, other, &Joint::other);
    return at == joints.end() ? nullptr : &*at;
}

}  // namespace

ScenePrior::ScenePrior(const ContactGraph& graph, std::span<const physics::Body> bodies,
                       const SurfaceSeams& seams, const std::vector<bool>& ground,
                       const Weights& weights)
    : graph_(graph),
      seams_(seams),
      joinery_(graph, bodies, seams, ground),
      ground_(ground),
      weights_(weights) {
    double total = 0;
    for (const physics::Body& b : bodies) total += b.volume_m3;
    for (const physics::Body& b : bodies)
        volume_share_.push_back(total > 0 ? b.volume_m3 / total : 0);
    carriers_.resize(bodies.size());
    loads_.resize(bodies.size());
    sides_.resize(bodies.size());
    for (const Carrying& c : graph.carryings) add_carrying(c);
    for (const physics::TouchingPair& pair : graph.pairs) add_touching(pair);
    between_.resize(bodies.size());
    std::map<std::pair<std::int32_t, std::int32_t>, Seam> between = seams.between;
    for (const physics::TouchingPair& pair : graph.pairs) between.try_emplace({pair.a, pair.b});
    for (const auto& [pair, seam] : between) {
        between_[static_cast<std::size_t>(pair.first)].push_back(
            {pair.second, seam, joinery_.made_as_one(pair.first, pair.second)});
    }
}

void ScenePrior::add_carrying(const Carrying& c) {
    // The shell is one body whatever the sampler does, so its own joints cost nothing.
    if (c.supporter < 0 || (ground_[static_cast<std::size_t>(c.supporter)] &&
                            ground_[static_cast<std::size_t>(c.supported)]))
        return;
    const double section = graph_.section_m2[static_cast<std::size_t>(c.supporter)];
    carriers_[static_cast<std::size_t>(c.supported)].push_back(
        {c.supporter,
         lost_freedom(section, c.area_m2) * (1 - joinery_.made_as_one(c.supporter, c.supported))});
    loads_[static_cast<std::size_t>(c.supporter)].push_back(c.supported);
}

void ScenePrior::add_touching(const physics::TouchingPair& pair) {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    if (ground_[a] && ground_[b]) return;
    if (find(carriers_[a], pair.b) || find(carriers_[b], pair.a)) return;
    const std::size_t axis = std::abs(pair.normal[0]) > 0.5   ? 0
                             : std::abs(pair.normal[1]) > 0.5 ? 1
                                                              : 2;
    const double of_a = graph_.silhouette_m2[a][axis], of_b = graph_.silhouette_m2[b][axis];
    const double solid = 1 - joinery_.made_as_one(pair.a, pair.b);
    if (ground_[a] || ground_[b]) {
        const double lost = lost_freedom(ground_[a] ? of_b : of_a, pair.area_m2);
        carriers_[ground_[a] ? b : a].push_back(
            {ground_[a] ? pair.a : pair.b, (beside_shell + (1 - beside_shell) * lost) * solid});
    } else {
        const double lost = lost_freedom(std::sqrt(of_a * of_b), pair.area_m2) * solid;
        sides_[a].push_back({pair.b, lost});
        sides_[b].push_back({pair.a, lost});
    }
}

double ScenePrior::lost_between(std::int32_t a, std::int32_t b) const {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const Joint* found = find(carriers_[i], b);
    if (!found) found = find(carriers_[j], a);
    if (!found) found = find(sides_[i], b);
    return found ? found->lost : 0;
}

double ScenePrior::operator()(const Group& group) const {
    double share = 0, lost = 0, one = 0, variation = 0;
    std::uint64_t pairs = 0;
    const auto add = [&](const Seam& s) {
        variation += s.variation;
        pairs += s.pairs;
    };
    for (const std::int32_t n : group) {
        const auto i = static_cast<std::size_t>(n);
        share += volume_share_[i];
        add(seams_.inside[i]);
        for (const Neighbour& neighbour : between_[i]) {
            if (!has(group, neighbour.other)) continue;
            add(neighbour.seam);
            one += neighbour.made_as_one;
        }
        for (const Joint& carrier : carriers_[i]) {
            if (has(group, carrier.other)) lost += carrier.lost;
        }
    }
    const double complexity = pairs ? variation / static_cast<double>(pairs) : 0;
    return weights_.size * std::pow(share, weights_.size_exponent) +
           weights_.complexity * complexity + weights_.freedom * (lost + held_at_sides(group)) -
           weights_.made_as_one * one;
}

double ScenePrior::held_at_sides(const Group& group) const {
    if (group.size() < 2) return 0;
    double sum = 0;
    for (const std::int32_t n : group) {
        if (ground_[static_cast<std::size_t>(n)]) continue;
        // A joint with what is above or below is paid for there.
        const auto i = static_cast<std::size_t>(n);
        const auto in_group = [&](std::int32_t other) { return has(group, other); };
        if (std::ranges::any_of(carriers_[i], in_group, &Joint::other) ||
            std::ranges::any_of(loads_[i], in_group))
            continue;
        double strongest = 1;
        for (const Joint& side : sides_[i])
            if (has(group, side.other)) strongest = std::min(strongest, side.lost);
        sum += strongest;
    }
    return sum;
}

}  // namespace topple::graph
