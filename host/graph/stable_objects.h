// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/table.h"
#include "graph/contact_graph.h"
#include "graph/joints.h"
#include "graph/known_links.h"
#include "physics/landscape.h"

// Grouping primitives into objects that stand (paper, 4.1).
namespace topple::graph {

// How surely primitives are the room's.
struct ShellOdds {
    Table<PrimitiveId, double> log_odds;
    Table<PrimitiveId, bool> pinned;  // taken for the room's whatever touches them
};

struct GroupingOptions {
    std::uint64_t seed = 1;
    // Found on rooms that no model was fitted on (docs/testing.md): the weight of S(O, W) beside
    // the joints' log-odds, and the bias of each joint (graph/joints.h), nats.
    double standing_weight = 0.3;
    double joint_bias = -1.3;
    double stability_level = 0;  // W of S(O, W), as a share of m g h
    double time_limit_s = 0;     // see SwendsenWangOptions
    std::function<bool()> cancelled;
    KnownLinks links;
    // Groups as found without the links: what these do not speak of keeps its group, and groups
    // keep their numbers as far as may be. Empty: nothing was.
    Table<PrimitiveId, std::int32_t> before;
};

struct Grouping {
    Table<PrimitiveId, std::int32_t> group;  // -1: fixed to the ground
    std::vector<double> energy_curve;        // best energy after each step of the annealing
};

// The rigid body that a set of primitives makes: its mass properties, and where it is held up by
// what is not part of it. What something below carries is held as well where it touches the room's
// shell at a height no less than its centre of mass: a ladder leans on its wall.
physics::Candidate candidate_of(const ContactGraph& graph,
                                TableView<PrimitiveId, physics::MassProperties> bodies,
                                const Table<PrimitiveId, bool>& shell,
                                std::vector<std::int32_t> primitives);

// Minimises Eq. 8 by Swendsen-Wang cuts with q = P(joint), from the greedy contraction of the
// joints on, over the groupings that keep to the links that are known. joints: sorted by (a, b).
Grouping group_primitives(device::Device& device, const ContactGraph& graph,
                          TableView<PrimitiveId, physics::MassProperties> bodies,
                          std::span<const Joint> joints, const ShellOdds& shell,
                          const GroupingOptions& options);

// Groups are numbered from 0 on without gaps: a number that is none's goes to the last one.
void close_gaps(Table<PrimitiveId, std::int32_t>& group);

// That both are one solid, of each of the graph's pairs: as it is known, by their joint, or as
// parts of the room. joints: sorted by (a, b); they may be those of another graph of the same
// primitives.
std::vector<double> pair_probabilities(const ContactGraph& graph, std::span<const Joint> joints,
                                       const ShellOdds& shell, const KnownLinks& links = {});

}  // namespace topple::graph
