// SPDX-License-Identifier: MIT
#include "geometry/minimum_cut.h"

#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <cmath>

namespace topple::geometry {
namespace {

constexpr double steps = 1e6;

std::int64_t in_steps(double cost) {
    return std::llround(steps * cost);
}

// Of a node: the arc to the source, and then the one to the sink. The source's arcs, and then the
// sink's, come after all nodes', in the order of the nodes.
constexpr std::uint32_t terminals = 2;

}  // namespace

// A node's arcs begin with those to the terminals, whether it has anything to do with them or not:
// that is for part() to say.
MinimumCut::MinimumCut(std::size_t nodes, std::span<const CutEdge> edges) : nodes_(nodes) {
    const auto count = static_cast<std::uint32_t>(nodes);
    const std::uint32_t source = count, sink = count + 1;
    std::vector<std::uint32_t> first(nodes + 3, 0);
    for (std::uint32_t n = 0; n < count; ++n) first[n + 1] = terminals;
    first[source + 1] = first[sink + 1] = count;
    for (const CutEdge& e : edges) {
        ++first[e.a + 1];
        ++first[e.b + 1];
    }
    for (std::size_t v = 0; v < nodes + 2; ++v) first[v + 1] += first[v];
    const std::size_t arcs = first.back();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ends(arcs);
    reverse_.resize(arcs);
    capacity_.assign(arcs, 0);
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    const auto connect = [&](std::uint32_t a, std::uint32_t b, std::int64_t capacity) {
        const std::uint32_t there = next[a]++, back = next[b]++;
        ends[there] = {a, b};
        ends[back] = {b, a};
        reverse_[there] = Arc(b, back);
        reverse_[back] = Arc(a, there);
        capacity_[there] = capacity_[back] = capacity;
    };
    for (std::uint32_t n = 0; n < count; ++n) {
        connect(n, source, 0);
        connect(n, sink, 0);
    }
    for (const CutEdge& e : edges) connect(e.a, e.b, in_steps(e.weight));
    graph_ = Graph(boost::edges_are_sorted, ends.begin(), ends.end(), count + 2);
    residual_.resize(arcs);
    distance_.resize(nodes + 2);
    parent_.resize(nodes + 2);
    tree_.resize(nodes + 2);
}

std::vector<bool> MinimumCut::part(std::span<const CutNode> nodes) {
    const auto source = static_cast<std::uint32_t>(nodes_), sink = source + 1;
    const auto out = [&](std::uint32_t v) { return out_edges(v, graph_).first; };
    if (nodes_ == 0) return {};
    for (std::uint32_t n = 0; n < source; ++n) {
        const Arc to_source = *out(n), to_sink = *(out(n) + 1);
        capacity_[reverse_[to_source.idx].idx] = in_steps(nodes[n].from_source);
        capacity_[to_sink.idx] = in_steps(nodes[n].from_sink);
    }
    const auto index = get(boost::edge_index, graph_);
    const auto vertex = get(boost::vertex_index, graph_);
    std::fill(tree_.begin(), tree_.end(), boost::gray_color);
    std::fill(distance_.begin(), distance_.end(), 0);
    boost::boykov_kolmogorov_max_flow(
        graph_, boost::make_iterator_property_map(capacity_.begin(), index),
        boost::make_iterator_property_map(residual_.begin(), index),
        boost::make_iterator_property_map(reverse_.begin(), index),
        boost::make_iterator_property_map(parent_.begin(), vertex),
        boost::make_iterator_property_map(tree_.begin(), vertex),
        boost::make_iterator_property_map(distance_.begin(), vertex), vertex, source, sink);
    std::vector<bool> inside(nodes_);
    for (std::size_t n = 0; n < nodes_; ++n) inside[n] = tree_[n] == tree_[source];
    return inside;
}

}  // namespace topple::geometry
