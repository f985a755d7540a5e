// SPDX-License-Identifier: MIT
#include "graph/group_energy.h"

#include <algorithm>
#include <cmath>

#include "physics/tipping.h"

namespace topple::graph {

GroupEnergy::GroupEnergy(const ContactGraph& contacts,
                         TableView<PrimitiveId, physics::MassProperties> bodies,
                         std::span<const Joint> joints, const ShellOdds& shell,
                         double standing_weight)
    : contacts_(contacts),
      bodies_(bodies),
      shell_(shell),
      standing_weight_(standing_weight),
      neighbours_(bodies.size()) {
    for (const Joint& j : joints) neighbours_[j.a].push_back({j.b, j.log_odds});
}

double GroupEnergy::joined(const GroupQuery& query) const {
    const ScratchSets::Lent lent(members_);
    StampedSet& members = *lent;
    members.clear(bodies_.size());
    for (const std::int32_t n : query.nodes) members.add(n);
    double sum = 0;
    for (const PrimitiveId p : query.nodes) {
        const bool fixed = shell_.pinned[p];
        if (query.pinned && !fixed) sum -= shell_.log_odds[p];
        for (const Neighbour& neighbour : neighbours_[p]) {
            if (!members.has(neighbour.other)) continue;
            // The room is one body whatever the sampler does.
            if (fixed && shell_.pinned[neighbour.other]) continue;
            sum -= neighbour.log_odds;
        }
    }
    return sum;
}

double GroupEnergy::standing(const GroupQuery& query) const {
    if (query.pinned || query.nodes.empty()) return 0;
    return standing_weight_ *
           standing_cost(candidate_of(contacts_, bodies_, shell_.pinned, query.nodes),
                         contacts_.voxel_m);
}

double GroupEnergy::operator()(const GroupQuery& query) const {
    return joined(query) + standing(query);
}

GroupEnergies GroupEnergy::callbacks() const {
    const auto energy = [this](std::span<const GroupQuery> queries, std::span<double> energies) {
        for (std::size_t n = 0; n < queries.size(); ++n) energies[n] = (*this)(queries[n]);
    };
    // Standing never costs less than nothing.
    const auto joints_alone = [this](const GroupQuery& query, double) { return joined(query); };
    return {energy, {joints_alone}};
}

}  // namespace topple::graph
