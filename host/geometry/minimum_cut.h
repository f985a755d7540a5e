// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
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
// The maximum flow by search trees from both ends that are kept from path to path: Boykov and
// Kolmogorov (2004), with the marks by which Kolmogorov's thesis (2003) finds new parents near the
// roots. A cut touches the surroundings of the smaller part alone: only arcs that flow has passed
// are set back for the next one, and what lies amid its own side is not searched.
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
    enum class Side : std::uint8_t { none, source, sink };
    // What a node hangs on: an arc to its parent, or one of these.
    static constexpr std::uint32_t no_arc = ~0u, root = ~0u - 1, orphan = ~0u - 2;

    std::span<const Arc> arcs_of(std::uint32_t n) const {
        return std::span(arcs_).subspan(first_[n], first_[n + 1] - first_[n]);
    }
    bool hangs(std::uint32_t n) const { return parent_[n] < orphan || parent_[n] == root; }
    // Whether flow may go on from a node away from its root along an arc.
    bool leads_on(std::uint32_t arc, Side side) const {
        return (side == Side::source ? arcs_[arc] : arcs_[arcs_[arc].reverse]).rest > 0;
    }
    void plant(std::span<const CutNode> nodes);
    void wake(std::uint32_t n);
    std::uint32_t grow(std::uint32_t n);
    void augment(std::uint32_t middle);
    std::int64_t least_rest(std::uint32_t from, Side side, std::int64_t least) const;
    void push(std::uint32_t from, Side side, std::int64_t flow);
    void pass(std::uint32_t arc, std::int64_t flow);
    void adopt(std::uint32_t n);
    std::uint32_t distance_to_root(std::uint32_t n);

    std::vector<std::uint32_t> first_;  // CSR over the nodes: their arcs
    std::vector<Arc> arcs_;
    std::vector<std::int64_t> capacity_;  // by arc
    std::vector<std::uint32_t> passed_;   // arcs with another rest than that
    std::vector<std::int64_t> excess_;    // of each node: from the source, or, below 0, to the sink
    std::vector<Side> side_;
    std::vector<std::uint32_t> parent_;
    // When a node's distance to its root was last found, and how many arcs it is.
    std::vector<std::uint32_t> when_, distance_;
    std::vector<bool> awake_;
    std::deque<std::uint32_t> active_, orphans_;
    std::uint32_t time_ = 0;
};

}  // namespace topple::geometry
