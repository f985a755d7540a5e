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
    : variation_(variation), weights_(weights) {
    double total = 0;
    for (const physics::Body& b : bodies) total += b.volume_m3;
    for (const physics::Body& b : bodies)
        volume_share_.push_back(total > 0 ? b.volume_m3 / total : 0);
    freedoms_.resize(bodies.size());
    for (const Carrying& c : graph.carryings) {
        // The shell is one body whatever the sampler does, so its own joints cost nothing.
        if (c.supporter < 0 || (ground[static_cast<std::size_t>(c.supporter)] &&
                                ground[static_cast<std::size_t>(c.supported)])) {
            continue;
        }
        const double carrier = graph.silhouette_m2[static_cast<std::size_t>(c.supporter)][2];
        freedoms_[static_cast<std::size_t>(c.supported)].push_back(
            {c.supporter, std::clamp(1 - c.area_m2 / carrier, 0.0, 1.0)});
    }
    between_.resize(bodies.size());
    for (const auto& [pair, sum] : variation.between) {
        between_[static_cast<std::size_t>(pair.first)].emplace_back(pair.second, sum);
    }
}

double ScenePrior::operator()(const Group& group) const {
    double share = 0, lost = 0;
    NormalVariation::Sum variation;
    const auto add = [&](const NormalVariation::Sum& s) {
        variation.sum += s.sum;
        variation.pairs += s.pairs;
    };
    for (const std::int32_t n : group) {
        const auto i = static_cast<std::size_t>(n);
        share += volume_share_[i];
        add(variation_.inside[i]);
        for (const auto& [other, sum] : between_[i]) {
            if (has(group, other)) add(sum);
        }
        for (const Freedom& f : freedoms_[i]) {
            if (has(group, f.supporter)) lost += f.lost;
        }
    }
    const double complexity =
        variation.pairs ? variation.sum / static_cast<double>(variation.pairs) : 0;
    return weights_.size * std::pow(share, weights_.size_exponent) +
           weights_.complexity * complexity + weights_.freedom * lost;
}

}  // namespace topple::graph
