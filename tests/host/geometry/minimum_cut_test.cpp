// SPDX-License-Identifier: MIT
#include "geometry/minimum_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

// What the sources still reach when flow has been sent along one shortest path after another, until
// there was none left.
std::vector<bool> reached(std::span<const CutNode> nodes, std::span<const CutEdge> edges) {
    const auto source = static_cast<std::uint32_t>(nodes.size()), sink = source + 1;
    struct Way {
        std::uint32_t to;
        std::int64_t rest;
    };
    std::vector<Way> ways;  // and, at the other place of each pair, back
    std::vector<std::vector<std::size_t>> of(nodes.size() + 2);
    const auto connect = [&](std::uint32_t a, std::uint32_t b, double there, double back) {
        of[a].push_back(ways.size());
        ways.push_back({b, std::llround(1e6 * there)});
        of[b].push_back(ways.size());
        ways.push_back({a, std::llround(1e6 * back)});
    };
    for (std::uint32_t n = 0; n < source; ++n) {
        connect(source, n, nodes[n].from_source, 0);
        connect(n, sink, nodes[n].from_sink, 0);
    }
    for (const CutEdge& e : edges) connect(e.a, e.b, e.weight, e.weight);
    while (true) {
        std::vector<std::size_t> by(of.size(), ways.size());
        std::vector<bool> seen(of.size());
        seen[source] = true;
        std::vector<std::uint32_t> next{source};
        for (std::size_t k = 0; k < next.size(); ++k) {
            for (const std::size_t w : of[next[k]]) {
                if (ways[w].rest == 0 || seen[ways[w].to]) continue;
                seen[ways[w].to] = true;
                by[ways[w].to] = w;
                next.push_back(ways[w].to);
            }
        }
        if (!seen[sink]) {
            seen.resize(nodes.size());
            return seen;
        }
        std::int64_t flow = ways[by[sink]].rest;
        for (std::uint32_t n = sink; n != source; n = ways[by[n] ^ 1].to)
            flow = std::min(flow, ways[by[n]].rest);
        for (std::uint32_t n = sink; n != source; n = ways[by[n] ^ 1].to) {
            ways[by[n]].rest -= flow;
            ways[by[n] ^ 1].rest += flow;
        }
    }
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

// Of a grid with many cuts of one cost, one after another.
TEST(MinimumCut, LeavesLeastWithTheSources) {
    constexpr std::uint32_t side = 16, count = side * side;
    std::mt19937 random(7);
    std::vector<CutEdge> edges;
    for (std::uint32_t n = 0; n < count; ++n) {
        if (n % side + 1 < side) edges.push_back({n, n + 1, 1.0 + random() % 2});
        if (n + side < count) edges.push_back({n, n + side, 1.0 + random() % 2});
        if (n % side + 1 < side && n + side < count) edges.push_back({n, n + side + 1, 1});
    }
    MinimumCut cut(count, edges);
    for (int trial = 0; trial < 40; ++trial) {
        std::vector<CutNode> nodes(count);
        for (CutNode& node : nodes) node.from_source = trial % 3 == 0 ? 0 : 0.1 * (random() % 3);
        for (int n = 0; n < 8; ++n) {
            nodes[random() % count] = {cut_never, 0};
            for (std::uint32_t near = random() % count, k = 0; k < 6 && near + k < count; ++k)
                nodes[near + k] = {0, trial % 2 ? cut_never : 1};
        }
        EXPECT_EQ(cut.part(nodes), reached(nodes, edges)) << "trial " << trial;
    }
}

}  // namespace
}  // namespace topple::geometry
