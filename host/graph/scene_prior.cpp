// SPDX-License-Identifier: MIT
#include "graph/scene_prior.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "graph/stamped_set.h"

namespace topple::graph {
namespace {

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

// A cube of four voxels; less says little about what it is, unless it keeps two things that far
// apart.
constexpr double least_voxels = 64, least_strut_voxels = 4;

// Whether a primitive of so many voxels is a strut where two things touch it that far from each
// other, in voxels: twice as long as it is thick. What is but noise has both joints at one place.
bool is_slender(double voxels, double length) {
    return length >= least_strut_voxels && length * length * length >= 4 * voxels;
}

// The primitives between one below and one above, as a lamp's pole is between its base and its
// shade. What touches things to its sides says less: clutter does.
std::vector<bool> find_struts(const ContactGraph& graph, std::span<const physics::Body> bodies) {
    constexpr double none = std::numeric_limits<double>::infinity();
    // Its lowest joint with something below, and its highest with something above.
    std::vector<double> foot(bodies.size(), none), head(bodies.size(), -none);
    for (const physics::TouchingPair& pair : graph.pairs) {
        if (std::abs(pair.normal[2]) < 0.5) continue;
        const bool a_is_below = pair.normal[2] > 0;
        const auto below = static_cast<std::size_t>(a_is_below ? pair.a : pair.b),
                   above = static_cast<std::size_t>(a_is_below ? pair.b : pair.a);
        head[below] = std::max(head[below], pair.center[2]);
        foot[above] = std::min(foot[above], pair.center[2]);
    }
    std::vector<bool> struts;
    for (std::size_t n = 0; n < bodies.size(); ++n)
        struts.push_back(
            is_slender(static_cast<double>(bodies[n].voxels), (head[n] - foot[n]) / graph.voxel_m));
    return struts;
}

}  // namespace

// What one group needs: its members, their roots, the scraps that have their joint, and the ranks
// of the joints among parts that aren't shell. Each thread keeps its own for the memory.
struct ScenePrior::Scratch {
    StampedSet members, hung;
    std::vector<std::int32_t> root;
    std::vector<std::int64_t> ranks;

    static Scratch& of_thread(std::size_t nodes) {
        thread_local Scratch scratch;
        scratch.members.clear(nodes);
        scratch.hung.clear(nodes);
        scratch.ranks.clear();
        if (scratch.root.size() < nodes) scratch.root.resize(nodes);
        return scratch;
    }
    std::int32_t root_of(std::int32_t node) {
        auto at = static_cast<std::size_t>(node);
        while (static_cast<std::size_t>(root[at]) != at)
            at = static_cast<std::size_t>(root[at] = root[static_cast<std::size_t>(root[at])]);
        return static_cast<std::int32_t>(at);
    }
};

ScenePrior::ScenePrior(const ContactGraph& graph, std::span<const physics::Body> bodies,
                       const SurfaceSeams& seams, const std::vector<bool>& ground,
                       const Weights& weights)
    : graph_(graph),
      seams_(seams),
      joinery_(graph, bodies, seams, ground),
      ground_(ground),
      weights_(weights),
      neighbours_(bodies.size()) {
    double total = 0;
    for (const physics::Body& b : bodies) total += b.volume_m3;
    for (const physics::Body& b : bodies)
        volume_share_.push_back(total > 0 ? b.volume_m3 / total : 0);
    const std::vector<bool> struts = find_struts(graph, bodies);
    for (std::size_t n = 0; n < bodies.size(); ++n)
        scrap_.push_back(static_cast<double>(bodies[n].voxels) < least_voxels && !struts[n]);
    const Ranks ranks = find_joints();
    std::map<std::pair<std::int32_t, std::int32_t>, Seam> between = seams.between;
    for (const auto& [pair, rank] : ranks) between.try_emplace(pair);
    for (const auto& [pair, seam] : between) {
        const auto rank = ranks.find(pair);
        neighbours_[static_cast<std::size_t>(pair.first)].push_back(
            {pair.second, seam, joinery_.made_as_one(pair.first, pair.second),
             rank == ranks.end() ? -1 : rank->second});
    }
}

ScenePrior::Ranks ScenePrior::find_joints() {
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
    Ranks ranks;
    for (const RankedJoint& joint : by_rank_)
        ranks[{joint.a, joint.b}] = static_cast<std::int64_t>(ranks.size());
    return ranks;
}

double ScenePrior::lost_by_carrying(const Carrying& c) const {
    // The shell is one body whatever the sampler does, so its own joints cost nothing.
    if (ground_[static_cast<std::size_t>(c.supporter)] &&
        ground_[static_cast<std::size_t>(c.supported)])
        return 0;
    return freedom_lost(graph_.section_m2[static_cast<std::size_t>(c.supporter)], c.area_m2) *
           (1 - std::max(joinery_.made_as_one(c.supporter, c.supported), 0.0));
}

double ScenePrior::lost_by_touching(const physics::TouchingPair& pair) const {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    if (ground_[a] && ground_[b]) return 0;
    const std::size_t axis = std::abs(pair.normal[0]) > 0.5   ? 0
                             : std::abs(pair.normal[1]) > 0.5 ? 1
                                                              : 2;
    const double of_a = graph_.silhouette_m2[a][axis], of_b = graph_.silhouette_m2[b][axis];
    const double solid = 1 - std::max(joinery_.made_as_one(pair.a, pair.b), 0.0);
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
    double share = 0, one = 0, variation = 0, lost_to_shell = 0;
    std::uint64_t pairs = 0;
    const auto add = [&](const Seam& s) {
        variation += s.variation;
        pairs += s.pairs;
    };
    Scratch& scratch = Scratch::of_thread(ground_.size());
    for (const std::int32_t n : group) scratch.members.add(n);
    for (const std::int32_t n : group) {
        const auto i = static_cast<std::size_t>(n);
        share += volume_share_[i];
        add(seams_.inside[i]);
        for (const Neighbour& neighbour : neighbours_[i]) {
            if (!scratch.members.has(neighbour.other)) continue;
            add(neighbour.seam);
            one += neighbour.made_as_one;
            if (neighbour.rank < 0) continue;
            if (is_shell(n) || is_shell(neighbour.other))
                lost_to_shell += by_rank_[static_cast<std::size_t>(neighbour.rank)].lost;
            else
                scratch.ranks.push_back(neighbour.rank);
        }
    }
    const double complexity = pairs ? variation / static_cast<double>(pairs) : 0;
    return weights_.size * std::pow(share, weights_.size_exponent) +
           weights_.complexity * complexity +
           weights_.freedom * (lost_to_shell + lost_among_parts(group, scratch)) -
           weights_.made_as_one * one;
}

// Kruskal's algorithm over the joints of the scratch's ranks.
double ScenePrior::lost_among_parts(const Group& group, Scratch& scratch) const {
    std::sort(scratch.ranks.begin(), scratch.ranks.end());
    for (const std::int32_t n : group) scratch.root[static_cast<std::size_t>(n)] = n;
    double sum = 0;
    const auto shells = std::ranges::count_if(group, [&](std::int32_t n) { return is_shell(n); });
    auto parts = static_cast<std::ptrdiff_t>(group.size()) - shells;
    for (const std::int64_t rank : scratch.ranks) {
        const RankedJoint& joint = by_rank_[static_cast<std::size_t>(rank)];
        const std::int32_t a = scratch.root_of(joint.a), b = scratch.root_of(joint.b);
        if (a == b || !hang(joint, scratch)) continue;
        scratch.root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
        sum += joint.lost;
        --parts;
    }
    return shells > 0 || parts < 1 ? sum : sum + not_joined * static_cast<double>(parts - 1);
}

// Takes note of the scraps at a joint; false where one of them has its only joint already.
bool ScenePrior::hang(const RankedJoint& joint, Scratch& scratch) const {
    const auto is_scrap = [&](std::int32_t n) { return scrap_[static_cast<std::size_t>(n)]; };
    for (const std::int32_t n : {joint.a, joint.b})
        if (is_scrap(n) && scratch.hung.has(n)) return false;
    for (const std::int32_t n : {joint.a, joint.b})
        if (is_scrap(n)) scratch.hung.add(n);
    return true;
}

}  // namespace topple::graph
