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

// The cheapest way to part an undirected graph in two: tells for each node whether it is on the
// sources' side. Of equally cheap ways it is the one that leaves least with the sources.
std::vector<bool> minimum_cut(std::span<const CutNode> nodes, std::span<const CutEdge> edges);

}  // namespace topple::geometry
