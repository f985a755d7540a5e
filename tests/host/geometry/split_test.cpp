// SPDX-License-Identifier: MIT
#include "geometry/split.h"

#include <random>

#include "geometry/minimum_cut.h"
#include "host/geometry/split_scenes.h"
#include "testing.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;
using scenes::Builder;
using scenes::majority;

Regions split_up(const Surfels& surfels) {
    ThreadPool threads(2);
    return split(surfels, threads);
}

TEST(Split, NothingGivesNothing) {
    Surfels none;
    none.cell_m = 0.02;
    none.neighbour_first = {0};
    const Regions regions = split_up(none);
    EXPECT_TRUE(regions.label.empty());
    EXPECT_TRUE(regions.regions.empty());
}

TEST(Split, OnePointHasNoRegion) {
    Builder scene;
    scene.point({1, 2, 3}, {0, 0, 1}, 0);
    const Regions regions = split_up(scene.surfels());
    ASSERT_EQ(regions.label.size(), 1u);
    EXPECT_EQ(regions.label[0], -1);
}

// Where both sides of a thin wall have surfels, a neighbourhood holds more of them than cells.
TEST(Split, NoiseOfLargeNeighbourhoodsIsTheirLowerQuartile) {
    constexpr std::uint32_t count = 60;
    Surfels s;
    s.cell_m = 0.01;
    s.neighbour_first = {0};
    for (std::uint32_t i = 0; i < count; ++i) {
        s.x.push_back(0.001f * static_cast<float>(i));
        s.roughness_m.push_back(0.001f + 0.0001f * static_cast<float>(i));
        for (auto* zero : {&s.y, &s.z, &s.nx, &s.ny}) zero->push_back(0);
        s.nz.push_back(1);
        s.weight.push_back(1);
        for (auto* index : {&s.cx, &s.cy, &s.cz}) index->push_back(0);
        for (std::uint32_t j = 0; j < count; ++j)
            if (j != i) s.neighbours.push_back(j);
        s.neighbour_first.push_back(static_cast<std::uint32_t>(s.neighbours.size()));
    }
    ThreadPool threads(1);
    const SplitScale scale = measure_scale(s, threads);
    // Three deviations of the sixteenth of 60, and of a tenth of a cell.
    for (const float tolerance : scale.tolerance_m)
        EXPECT_NEAR(tolerance, 3 * std::hypot(0.0025, 0.001), 0.001);
}

TEST(Split, CleanPlaneIsOneRegion) {
    Builder scene;
    scene.face({0, 0, 0.503}, {1, 0, 0}, {0, 1, 0}, 0);
    const Surfels s = scene.surfels();
    const Regions regions = split_up(s);
    ASSERT_EQ(regions.regions.size(), 1u);
    EXPECT_EQ(regions.regions[0].model.degree, 1);
    EXPECT_EQ(regions.regions[0].surfels, s.size());
    EXPECT_LT(regions.regions[0].residual_m, 1e-4);
    EXPECT_GT(regions.regions[0].model.value(0.5, 0.5, 0.6), 0.09);
}

TEST(Split, ThickWallIsOneRegion) {
    Builder scene;
    scene.noise_m = 0.012;
    scene.face({0.01, 0, 0}, {0, 2, 0}, {0, 0, 2}, 0);
    const Surfels s = scene.surfels();
    const Regions regions = split_up(s);
    EXPECT_GT(majority(scene, s, regions.label, 0).share, 0.98);
    EXPECT_EQ(regions.regions[majority(scene, s, regions.label, 0).label].model.degree, 1);
}

TEST(Split, CurvedSurfacesStayInOnePiece) {
    Builder scene;
    scene.cell_m = 0.01;
    scene.noise_m = 0.001;
    scene.ball({0, 0, 0}, 0.08, 0);
    scene.tube({1, 0, 0}, 0.04, 0.25, false, 1);
    scene.tube({2, 0, 0}, 0.11, 0.15, false, 2);
    const Surfels s = scene.surfels();
    const Regions regions = split_up(s);
    for (int body = 0; body < 3; ++body) {
        const auto most = majority(scene, s, regions.label, body);
        EXPECT_GT(most.share, 0.95) << "body " << body;
        EXPECT_EQ(regions.regions[most.label].model.degree, 2) << "body " << body;
    }
}

TEST(Split, FacesOfABoxAreSeparatePlanes) {
    Builder scene;
    const Vector3d x(0.4, 0, 0), y(0, 0.3, 0), z(0, 0, 0.5);
    scene.face(z, x, y, 0);
    scene.face({0, 0, 0}, x, z, 1);
    scene.face(x, y, z, 2);
    const Surfels s = scene.surfels();
    const Regions regions = split_up(s);
    std::set<std::int32_t> ids;
    for (int face = 0; face < 3; ++face) {
        const auto most = majority(scene, s, regions.label, face);
        EXPECT_GT(most.share, 0.93) << "face " << face;
        EXPECT_EQ(regions.regions[most.label].model.degree, 1);
        ids.insert(most.label);
    }
    EXPECT_EQ(ids.size(), 3u);
}

TEST(Split, LabelsAreWithinRangeAndCountsAgree) {
    Builder scene;
    scene.noise_m = 0.004;
    scene.face({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    scene.box({0, 0, 0}, {0.2, 0.2, 0.2}, 1);
    scene.ball({-0.5, -0.5, 0.1}, 0.1, 2);
    const Surfels s = scene.surfels();
    const Regions regions = split_up(s);
    std::vector<std::uint64_t> count(regions.regions.size(), 0);
    for (const std::int32_t label : regions.label) {
        ASSERT_LT(label, static_cast<std::int32_t>(count.size()));
        if (label >= 0) ++count[label];
    }
    for (std::size_t k = 0; k < count.size(); ++k) EXPECT_EQ(count[k], regions.regions[k].surfels);
    EXPECT_EQ(split_up(s).label, regions.label);
}

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
