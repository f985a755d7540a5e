// SPDX-License-Identifier: MIT
#pragma once

#include <boost/graph/compressed_sparse_row_graph.hpp>
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
class MinimumCut {
  public:
    // Nodes below `nodes`, which is below 2^28.
    MinimumCut(std::size_t nodes, std::span<const CutEdge> edges);

    // The cheapest way: tells for each node whether it is on the sources' side. Of equally cheap
    // ways it is the one that leaves least with the sources. `nodes`: what each one costs.
    std::vector<bool> part(std::span<const CutNode> nodes);

  private:
    using Graph =
        boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                           boost::no_property, std::uint32_t, std::uint32_t>;
    using Arc = boost::graph_traits<Graph>::edge_descriptor;

    std::size_t nodes_;
    Graph graph_;
    std::vector<Arc> reverse_;                     // by arc
    std::vector<std::int64_t> capacity_;           // by arc, steps of cost
    std::vector<std::int64_t> residual_;           // by arc
    std::vector<std::int32_t> distance_;           // by vertex
    std::vector<Arc> parent_;                      // by vertex
    std::vector<boost::default_color_type> tree_;  // by vertex
};

}  // namespace topple::geometry
