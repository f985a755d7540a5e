// SPDX-License-Identifier: MIT
#include "geometry/minimum_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace topple::geometry {
namespace {

std::vector<bool> minimum_cut(std::span<const CutNode> nodes, std::span<const CutEdge> edges) {
    return MinimumCut(nodes.size(), edges).part(nodes);
}

double cost(std::span<const CutNode> nodes, std::span<const CutEdge> edges,
            const std::vector<bool>& inside) {
    double sum = 0;
    for (const CutEdge& e : edges)
        if (inside[e.a] != inside[e.b]) sum += e.weight;
    for (std::size_t n = 0; n < nodes.size(); ++n)
        sum += inside[n] ? nodes[n].from_sink : nodes[n].from_source;
    return sum;
}

TEST(MinimumCut, PartsAtTheNeck) {
    // 0-1-2 and 3-4-5, tied by the one weak edge between 2 and 3.
    const std::vector<CutEdge> edges{{0, 1, 2}, {1, 2, 2}, {2, 3, 1}, {3, 4, 2}, {4, 5, 2}};
    std::vector<CutNode> nodes(6);
    nodes[0].from_source = nodes[5].from_sink = cut_never;
    EXPECT_EQ(minimum_cut(nodes, edges),
              (std::vector<bool>{true, true, true, false, false, false}));
    // Two nodes that would rather be elsewhere outweigh it.
    nodes[3].from_source = nodes[4].from_source = 1;
    EXPECT_EQ(minimum_cut(nodes, edges), (std::vector<bool>{true, true, true, true, true, false}));
}

TEST(MinimumCut, WhatTouchesNothingIsNotWithTheSources) {
    const std::vector<CutNode> nodes{{cut_never, 0}, {0, cut_never}, {0, 0}};
    EXPECT_EQ(minimum_cut(nodes, {}), (std::vector<bool>{true, false, false}));
    EXPECT_TRUE(minimum_cut({}, {}).empty());
}

// Against all ways of parting ten nodes.
TEST(MinimumCut, NoOtherCutIsCheaper) {
    constexpr std::uint32_t count = 10;
    std::mt19937 random(5);
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<CutNode> nodes(count);
        std::vector<CutEdge> edges;
        for (std::uint32_t a = 0; a < count; ++a) {
            nodes[a] = {static_cast<double>(random() % 5), static_cast<double>(random() % 5)};
            for (std::uint32_t b = a + 1; b < count; ++b)
                if (random() % 3 == 0) edges.push_back({a, b, 1.0 + random() % 9});
        }
        nodes[0].from_source = nodes[9].from_sink = cut_never;
        const std::vector<bool> found = minimum_cut(nodes, edges);
        double least = cut_never;
        for (std::uint32_t ways = 0; ways < 1u << count; ++ways) {
            std::vector<bool> inside(count);
            for (std::uint32_t n = 0; n < count; ++n) inside[n] = (ways >> n & 1) != 0;
            least = std::min(least, cost(nodes, edges, inside));
        }
        EXPECT_DOUBLE_EQ(cost(nodes, edges, found), least) << "trial " << trial;
    }
}

}  // namespace
}  // namespace topple::geometry
