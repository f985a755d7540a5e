// SPDX-License-Identifier: MIT
#include "graph/scene_prior.h"

#include <algorithm>
#include <cmath>

namespace topple::graph {
namespace {

bool has(const Group& group, std::int32_t node) {
    return std::binary_search(group.begin(), group.end(), node);
}

}  // namespace

ScenePrior::ScenePrior(const ContactGraph& graph, std::span<const physics::Body> bodies,
                       const NormalVariation& variation, const std::vector<bool>& ground,
                       const Weights& weights)
    : variation_(variation), weights_(weights), ground_(ground) {
    double total = 0;
    for (const physics::Body& b : bodies) total += b.volume_m3;
    for (const physics::Body& b : bodies)
        volume_share_.push_back(total > 0 ? b.volume_m3 / total : 0);
    for (const Carrying& c : graph.carryings) {
        if (c.supporter < 0) continue;
        const double carrier = graph.silhouette_m2[static_cast<std::size_t>(c.supporter)][2];
        freedoms_.push_back(
            {c.supporter, c.supported, std::clamp(1 - c.area_m2 / carrier, 0.0, 1.0)});
    }
}

double ScenePrior::operator()(const Group& group) const {
    double share = 0;
    NormalVariation::Sum variation;
    const auto add = [&](const NormalVariation::Sum& s) {
        variation.sum += s.sum;
        variation.pairs += s.pairs;
    };
    for (const std::int32_t n : group) {
        share += volume_share_[static_cast<std::size_t>(n)];
        add(variation_.inside[static_cast<std::size_t>(n)]);
    }
    for (const auto& [pair, sum] : variation_.between) {
        if (has(group, pair.first) && has(group, pair.second)) add(sum);
    }
    double lost = 0;
    for (const Freedom& f : freedoms_) {
        // The shell is one body whatever the sampler does, so its own joints cost nothing.
        const bool shell = ground_[static_cast<std::size_t>(f.supporter)] &&
                           ground_[static_cast<std::size_t>(f.supported)];
        if (!shell && has(group, f.supporter) && has(group, f.supported)) lost += f.lost;
    }
    const double complexity =
        variation.pairs ? variation.sum / static_cast<double>(variation.pairs) : 0;
    return weights_.size * std::pow(share, weights_.size_exponent) +
           weights_.complexity * complexity + weights_.freedom * lost;
}

}  // namespace topple::graph
