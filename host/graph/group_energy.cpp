// SPDX-License-Identifier: MIT
#include "graph/group_energy.h"

#include <algorithm>

namespace topple::graph {

GroupEnergy::GroupEnergy(device::Device& device, const ContactGraph& contacts,
                         TableView<PrimitiveId, physics::MassProperties> bodies,
                         std::span<const Joint> joints, const ShellOdds& shell,
                         double standing_weight, double stability_level)
    : voxel_m_(contacts.voxel_m),
      shell_(shell),
      standing_weight_(standing_weight),
      stability_level_(stability_level),
      neighbours_(bodies.size()),
      stances_(device, contacts, bodies, shell.pinned) {
    for (const Joint& j : joints) neighbours_[j.a].push_back({j.b, j.log_odds});
}

double GroupEnergy::joined(const GroupQuery& query) const {
    const ScratchSets::Lent lent(members_);
    StampedSet& members = *lent;
    members.clear(neighbours_.size());
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

void GroupEnergy::of(std::span<const GroupQuery> queries, std::span<double> energies) {
    std::vector<GroupQuery> standing;
    std::vector<std::size_t> number;
    for (std::size_t n = 0; n < queries.size(); ++n) {
        energies[n] = joined(queries[n]);
        if (queries[n].pinned || queries[n].nodes.empty()) continue;
        standing.push_back(queries[n]);
        number.push_back(n);
    }
    const std::vector<Stance> stances = stances_.of(standing);
    for (std::size_t n = 0; n < stances.size(); ++n)
        energies[number[n]] +=
            standing_weight_ * standing_cost(stances[n], voxel_m_, stability_level_);
}

GroupEnergies GroupEnergy::callbacks() {
    // Standing never costs less than nothing.
    const auto joints_alone = [this](const GroupQuery& query, double) { return joined(query); };
    return {[this](std::span<const GroupQuery> queries, std::span<double> energies) {
                of(queries, energies);
            },
            {joints_alone}};
}

}  // namespace topple::graph
