// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "core/table.h"
#include "graph/contact_graph.h"
#include "graph/group_stances.h"
#include "graph/joints.h"
#include "graph/stable_objects.h"
#include "graph/stamped_set.h"
#include "graph/swendsen_wang.h"

namespace topple::graph {

// The energy of a group of primitives, in nats (Eq. 8 with a fitted prior):
//   - sum of the log-odds of the joints within it, which may be biased_joints(),
//   + standing_weight * S(O, W), see standing_cost().
// Of the ground: less the log-odds that each of its primitives is the room's, but for those that
// are taken for the room's anyhow; S = 0. Keeps references to its arguments.
class GroupEnergy {
  public:
    GroupEnergy(device::Device& device, const ContactGraph& contacts,
                TableView<PrimitiveId, physics::MassProperties> bodies,
                std::span<const Joint> joints, const ShellOdds& shell, double standing_weight,
                double stability_level = 0);

    // From one thread at a time.
    void of(std::span<const GroupQuery> queries, std::span<double> energies);
    // This energy with its bounds, for the sampler.
    GroupEnergies callbacks();

  private:
    struct Neighbour {
        std::int32_t other;  // the higher of the two
        double log_odds;
    };
    double joined(const GroupQuery& query) const;

    double voxel_m_;
    const ShellOdds& shell_;
    double standing_weight_, stability_level_;
    Table<PrimitiveId, std::vector<Neighbour>> neighbours_;
    GroupStances stances_;
    mutable ScratchSets members_;
};

}  // namespace topple::graph
