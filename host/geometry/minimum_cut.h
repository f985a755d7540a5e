// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace topple::geometry {

// An edge between two nodes; parting them costs `weight`, above 0.
struct CutEdge {
    std::uint32_t a = 0, b = 0;
    double weight = 0;
};

// What it costs to take a node from the sources' side, or from the sinks'; not below 0.
struct CutNode {
    double from_source = 0, from_sink = 0;
};
inline constexpr double cut_never = 1e9;

// An undirected graph that is parted in two at the least cost, again and again. Costs are counted
// in steps of 1e-6, so that ways of the same cost are known as such.
//
// By the maximum flow, found by pushing and relabelling (Goldberg and Tarjan 1988), the highest
// label first, with exact labels now and then and without what lies above a gap in them (Cherkassky
// and Goldberg 1997). Where every node of a face would rather stay with the sources by a little, as
// here, search trees send each little along a path of its own. The flow runs backwards, from the
// sinks to the sources: in the end what still reaches a source is what is left with them.
class MinimumCut {
  public:
    // Nodes below `nodes`, which is below 2^28.
    MinimumCut(std::size_t nodes, std::span<const CutEdge> edges);

    // The cheapest way: tells for each node whether it is on the sources' side. Of equally cheap
    // ways it is the one that leaves least with the sources. `nodes`: what each one costs.
    std::vector<bool> part(std::span<const CutNode> nodes);

  private:
    struct Arc {
        std::uint32_t to = 0, reverse = 0;
        std::int64_t rest = 0;  // of its capacity, steps of cost
    };

    void supply(std::span<const CutNode> nodes);
    bool find_levels();
    void wake(std::uint32_t n);
    void push_all();
    void discharge(std::uint32_t n);
    void lift(std::uint32_t n);
    void send(Arc& arc, std::int64_t flow) {
        arc.rest -= flow;
        arcs_[arc.reverse].rest += flow;
    }

    std::vector<std::uint32_t> first_;  // CSR over the nodes: their arcs
    std::vector<Arc> arcs_;
    std::vector<std::int64_t> capacity_;  // by arc
    std::vector<std::int64_t> around_;    // of each node: of all its arcs
    // Of each node: what has come to it and not gone on, and what it may still give to the source.
    std::vector<std::int64_t> excess_, room_;
    std::vector<std::uint8_t> is_sink_;  // has more for its neighbours than they could take
    // Arcs from a node to a source, at least, and how many nodes have each level. What is above a
    // gap, a level that no node had, waits for levels to be exact.
    std::vector<std::uint32_t> level_, count_;
    std::uint32_t gap_ = 0;
    std::vector<std::uint32_t> next_;                 // of each node: the arc to be tried next
    std::vector<std::vector<std::uint32_t>> active_;  // nodes with an excess, by level
    std::size_t highest_ = 0;                         // level of these, at most
    std::size_t work_ = 0;                            // since levels were last exact
    std::vector<std::uint32_t> reached_;
};

}  // namespace topple::geometry
