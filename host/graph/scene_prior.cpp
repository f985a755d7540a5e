// SPDX-License-Identifier: MIT
#include "graph/scene_prior.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace topple::graph {
namespace {

bool has(const Group& group, std::int32_t node) {
    return std::binary_search(group.begin(), group.end(), node);
}

// The freedom of a part on a face of `face_m2` that fixing it there by a joint of `joint_m2` takes:
// the ratio of the paper on a logarithmic scale, from 0 for all of the face to 1 for a
// thousandth of it, so that a faint joint is worse than a poor one.
double freedom_lost(double face_m2, double joint_m2) {
    constexpr double decades = 3;
    if (joint_m2 <= 0) return 1;
    return std::clamp(std::log10(face_m2 / joint_m2) / decades, 0.0, 1.0);
}

// Furniture stands against walls without being fixed to them: the least freedom that doing so
// would take.
constexpr double beside_shell = 0.5;

// What it costs that parts of a group are joined by scraps only: more than any fall that it saves.
constexpr double not_joined = 5;

// A cube of four voxels; less says little about what it is.
constexpr std::uint64_t least_voxels = 64;

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
    for (const physics::Body& b : bodies) scrap_.push_back(b.voxels < least_voxels);
    find_joints();
    between_.resize(bodies.size());
    std::map<std::pair<std::int32_t, std::int32_t>, Seam> between = seams.between;
    for (const physics::TouchingPair& pair : graph.pairs) between.try_emplace({pair.a, pair.b});
    for (const auto& [pair, seam] : between) {
        between_[static_cast<std::size_t>(pair.first)].push_back(
            {pair.second, seam, joinery_.made_as_one(pair.first, pair.second)});
    }
}

void ScenePrior::find_joints() {
    for (const Carrying& c : graph_.carryings) {
        if (c.supporter < 0) continue;
        const double lost = lost_by_carrying(c);
        const auto [at, fresh] = lost_.try_emplace(std::minmax(c.supporter, c.supported), lost);
        if (!fresh) at->second = std::min(at->second, lost);
    }
    for (const physics::TouchingPair& pair : graph_.pairs) {
        if (!lost_.contains({pair.a, pair.b})) lost_[{pair.a, pair.b}] = lost_by_touching(pair);
    }
    for (const auto& [pair, lost] : lost_) by_rank_.push_back({lost, pair.first, pair.second});
    std::ranges::stable_sort(by_rank_, {}, &RankedJoint::lost);
    joints_.resize(ground_.size());
    for (std::uint32_t rank = 0; rank < by_rank_.size(); ++rank) {
        const RankedJoint& joint = by_rank_[rank];
        joints_[static_cast<std::size_t>(joint.a)].push_back({joint.b, rank});
    }
}

double ScenePrior::lost_by_carrying(const Carrying& c) const {
    // The shell is one body whatever the sampler does, so its own joints cost nothing.
    if (ground_[static_cast<std::size_t>(c.supporter)] &&
        ground_[static_cast<std::size_t>(c.supported)])
        return 0;
    return freedom_lost(graph_.section_m2[static_cast<std::size_t>(c.supporter)], c.area_m2) *
           (1 - joinery_.made_as_one(c.supporter, c.supported));
}

double ScenePrior::lost_by_touching(const physics::TouchingPair& pair) const {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    if (ground_[a] && ground_[b]) return 0;
    const std::size_t axis = std::abs(pair.normal[0]) > 0.5   ? 0
                             : std::abs(pair.normal[1]) > 0.5 ? 1
                                                              : 2;
    const double of_a = graph_.silhouette_m2[a][axis], of_b = graph_.silhouette_m2[b][axis];
    const double solid = 1 - joinery_.made_as_one(pair.a, pair.b);
    if (!ground_[a] && !ground_[b])
        return (freedom_lost(of_a, pair.area_m2) + freedom_lost(of_b, pair.area_m2)) * solid;
    const double lost = freedom_lost(ground_[a] ? of_b : of_a, pair.area_m2);
    return (beside_shell + (1 - beside_shell) * lost) * solid;
}

double ScenePrior::lost_between(std::int32_t a, std::int32_t b) const {
    const auto at = lost_.find(std::minmax(a, b));
    return at == lost_.end() ? 0 : at->second;
}

double ScenePrior::operator()(const Group& group) const {
    double share = 0, one = 0, variation = 0;
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
    }
    const double complexity = pairs ? variation / static_cast<double>(pairs) : 0;
    return weights_.size * std::pow(share, weights_.size_exponent) +
           weights_.complexity * complexity + weights_.freedom * lost_freedom(group) -
           weights_.made_as_one * one;
}

// Kruskal's algorithm over the joints within the group.
double ScenePrior::lost_freedom(const Group& group) const {
    if (group.size() < 2) return 0;
    std::vector<std::uint32_t> ranks;
    for (const std::int32_t n : group) {
        for (const Joint& joint : joints_[static_cast<std::size_t>(n)])
            if (has(group, joint.other)) ranks.push_back(joint.rank);
    }
    std::sort(ranks.begin(), ranks.end());
    std::vector<std::size_t> root(group.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto root_of = [&](std::int32_t node) {
        auto at = static_cast<std::size_t>(std::ranges::lower_bound(group, node) - group.begin());
        while (root[at] != at) at = root[at] = root[root[at]];
        return at;
    };
    const auto is_shell = [&](std::int32_t n) { return ground_[static_cast<std::size_t>(n)]; };
    std::vector<bool> hung(group.size());  // scraps that have their joint
    double sum = 0;
    std::size_t parts = static_cast<std::size_t>(
        std::ranges::count_if(group, [&](std::int32_t n) { return !is_shell(n); }));
    const bool shell = parts < group.size();
    for (const std::uint32_t rank : ranks) {
        const RankedJoint& joint = by_rank_[rank];
        if (is_shell(joint.a) || is_shell(joint.b)) {
            sum += joint.lost;
            continue;
        }
        const std::size_t a = root_of(joint.a), b = root_of(joint.b);
        if (a == b || !hang(joint, group, hung)) continue;
        root[std::max(a, b)] = std::min(a, b);
        sum += joint.lost;
        --parts;
    }
    return shell || parts == 0 ? sum : sum + not_joined * static_cast<double>(parts - 1);
}

// Takes note of the scraps at a joint; false where one of them has its only joint already.
bool ScenePrior::hang(const RankedJoint& joint, const Group& group, std::vector<bool>& hung) const {
    const auto is_scrap = [&](std::int32_t n) { return scrap_[static_cast<std::size_t>(n)]; };
    const auto place = [&](std::int32_t n) {
        return static_cast<std::size_t>(std::ranges::lower_bound(group, n) - group.begin());
    };
    for (const std::int32_t n : {joint.a, joint.b})
        if (is_scrap(n) && hung[place(n)]) return false;
    for (const std::int32_t n : {joint.a, joint.b})
        if (is_scrap(n)) hung[place(n)] = true;
    return true;
}

}  // namespace topple::graph
