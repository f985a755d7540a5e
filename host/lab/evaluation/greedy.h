// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "graph/swendsen_wang.h"

// The paper's second baseline of Table 3: matching pursuit over the energy that Swendsen-Wang cuts
// sample.
namespace topple::evaluation {

// The energies of groups, as swendsen_wang_cuts asks for them.
using EnergyOf = std::function<void(std::span<const graph::GroupQuery>, std::span<double>)>;

struct GreedyPartition {
    std::vector<std::int32_t> label;  // as swendsen_wang_cuts numbers them: pinned -1
    double energy = 0;
};

// Starts from one group per node, the pinned together, and joins the two groups with an edge
// between them whose union lowers the energy most, until none does; of equal ones the two with the
// lowest nodes. It never parts what it has joined.
GreedyPartition greedy_merges(std::int32_t nodes, std::span<const graph::Edge> edges,
                              const std::vector<bool>& pinned, const EnergyOf& energy_of);

}  // namespace topple::evaluation
