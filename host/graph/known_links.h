// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/table.h"
#include "graph/joints.h"
#include "graph/swendsen_wang.h"

// What somebody knows of the grouping beforehand.
namespace topple::graph {

// Pairs of primitives that are one object, whether they touch or not, and pairs that are none.
struct KnownLinks {
    std::vector<std::pair<std::int32_t, std::int32_t>> together, apart;
    bool none() const { return together.empty() && apart.empty(); }
};

// A grouping that links change where they speak of it, and nowhere else: of the groups that they
// name a primitive of, and of the ground's of those that they name, and what likely is one with
// such. These group anew among themselves and with the ground; all others keep their groups.
class KeptGrouping {
  public:
    // group: without the links, -1 for the ground's. Keeps a reference to it.
    KeptGrouping(KnownLinks links, const Table<PrimitiveId, std::int32_t>& group,
                 std::span<const Joint> joints, const Table<PrimitiveId, bool>& pinned);

    // With what stays as it is.
    const KnownLinks& links() const { return links_; }
    // The joints by which something may change.
    std::vector<Joint> of_open(std::span<const Joint> joints) const;

  private:
    KnownLinks links_;
    const Table<PrimitiveId, std::int32_t>& group_;
    Table<PrimitiveId, bool> open_;
};

// The primitives as nodes of a graph in which all that are one object for sure are one node: what
// groups those groups what is known. Nodes are numbered by their lowest primitive; without links
// they are the primitives.
class LinkedNodes {
  public:
    LinkedNodes(std::int32_t primitives, const KnownLinks& links);

    std::int32_t size() const { return static_cast<std::int32_t>(members_.size()); }
    NodeId node_of(PrimitiveId primitive) const { return node_[primitive]; }
    std::span<const std::int32_t> members(NodeId node) const { return members_[node]; }
    // Between nodes, in their order: there may be several between two.
    std::vector<Joint> joints(std::span<const Joint> of_primitives) const;
    // Whether any primitive is.
    Table<NodeId, bool> pinned(const Table<PrimitiveId, bool>& primitives) const;
    Table<NodeId, double> sums(TableView<PrimitiveId, double> of_primitives) const;
    // Of each node the nodes that it is kept apart from, ascending; empty where none is from any.
    const Table<NodeId, std::vector<std::int32_t>>& apart() const { return apart_; }
    // Those of groups of primitives, asked for groups of nodes.
    GroupEnergies energies(GroupEnergies of_primitives) const;
    Table<PrimitiveId, std::int32_t> of_primitives(TableView<NodeId, std::int32_t> label) const;
    // Whether two primitives are known to be one object, or none.
    std::optional<bool> one_object(PrimitiveId a, PrimitiveId b) const;

  private:
    Table<PrimitiveId, NodeId> node_;
    Table<NodeId, std::vector<std::int32_t>> members_;  // ascending
    Table<NodeId, std::vector<std::int32_t>> apart_;
};

}  // namespace topple::graph
