// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graph/joints.h"
#include "graph/swendsen_wang.h"

namespace topple::graph {

// Greedy additive edge contraction (Keuper et al., Efficient decomposition of image and mesh graphs
// by lifted multicuts, ICCV 2015): joins the two groups with the largest sum of log-odds between
// them until none is above 0. The label of each node is the lowest node of its group; all that are
// pinned are one group from the start, and `to_pinned`, of each
// node, counts beside its joints with them. Of equal sums the lowest nodes come first.
// apart: of each node those that no group may hold beside it, or empty.
Table<NodeId, std::int32_t> contract_greedily(
    std::int32_t nodes, std::span<const Joint> joints, const Table<NodeId, bool>& pinned,
    TableView<NodeId, double> to_pinned, TableView<NodeId, std::vector<std::int32_t>> apart = {});

}  // namespace topple::graph
