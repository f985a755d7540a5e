// SPDX-License-Identifier: MIT
#include "geometry/minimum_cut.h"

// Boost's iterators over edges hold an optional that GCC takes for used before it is set.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>

namespace topple::geometry {
namespace {

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
using Edge = Traits::edge_descriptor;
using Node = boost::property<boost::vertex_color_t, boost::default_color_type,
                             boost::property<boost::vertex_distance_t, long,
                                             boost::property<boost::vertex_predecessor_t, Edge>>>;
using Flow = boost::property<boost::edge_capacity_t, double,
                             boost::property<boost::edge_residual_capacity_t, double,
                                             boost::property<boost::edge_reverse_t, Edge>>>;
using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, Node, Flow>;

}  // namespace

std::vector<bool> minimum_cut(std::span<const CutNode> nodes, std::span<const CutEdge> edges) {
    Graph graph(nodes.size() + 2);
    const std::size_t source = nodes.size(), sink = source + 1;
    const auto capacity = get(boost::edge_capacity, graph);
    const auto reverse = get(boost::edge_reverse, graph);
    const auto connect = [&](std::size_t a, std::size_t b, double there, double back) {
        const Edge e = add_edge(a, b, graph).first, r = add_edge(b, a, graph).first;
        capacity[e] = there;
        capacity[r] = back;
        reverse[e] = r;
        reverse[r] = e;
    };
    for (const CutEdge& e : edges) connect(e.a, e.b, e.weight, e.weight);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (nodes[n].from_source > 0) connect(source, n, nodes[n].from_source, 0);
        if (nodes[n].from_sink > 0) connect(n, sink, nodes[n].from_sink, 0);
    }
    boykov_kolmogorov_max_flow(graph, source, sink);
    const auto colour = get(boost::vertex_color, graph);
    std::vector<bool> inside(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) inside[n] = colour[n] == colour[source];
    return inside;
}

}  // namespace topple::geometry
