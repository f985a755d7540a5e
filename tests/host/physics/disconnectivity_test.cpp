// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>

#include "host/physics/solids.h"
#include "kernels/device_compare.h"
#include "oracle/flood_oracle.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

TEST(SphereMesh, IsAGeodesicSphere) {
    for (const unsigned f : {1U, 2U, 3U, 16U, 33U}) {
        SCOPED_TRACE(f);
        const SphereMesh mesh = geodesic_sphere(f);
        ASSERT_EQ(mesh.size(), 10U * f * f + 2);
        EXPECT_EQ(mesh.x[0], 0);
        EXPECT_EQ(mesh.y[0], 0);
        EXPECT_EQ(mesh.z[0], 1);
        std::size_t fives = 0;
        double shortest = 9, longest = 0;
        for (std::uint32_t v = 0; v < mesh.size(); ++v) {
            EXPECT_NEAR(mesh.x[v] * mesh.x[v] + mesh.y[v] * mesh.y[v] + mesh.z[v] * mesh.z[v], 1,
                        1e-6);
            std::vector<std::uint32_t> around(mesh.neighbour.begin() + v * 6,
                                              mesh.neighbour.begin() + v * 6 + 6);
            if (around[5] == around[0]) {
                ++fives;
                around.pop_back();
            }
            for (const std::uint32_t w : around) {
                EXPECT_NE(w, v);
                const auto* back = &mesh.neighbour[w * 6];
                EXPECT_NE(std::find(back, back + 6, v), back + 6) << v << " " << w;
                const double length =
                    std::hypot(mesh.x[v] - mesh.x[w], mesh.y[v] - mesh.y[w], mesh.z[v] - mesh.z[w]);
                shortest = std::min(shortest, length);
                longest = std::max(longest, length);
            }
            std::sort(around.begin(), around.end());
            EXPECT_EQ(std::unique(around.begin(), around.end()), around.end());
        }
        EXPECT_EQ(fives, 12U);
        EXPECT_LT(longest / shortest, 1.5);
    }
    EXPECT_THROW(geodesic_sphere(0), Error);
    EXPECT_THROW(geodesic_sphere(5000), Error);
}

// Whether b can be reached from a without rising above `level`: by plain search.
bool connected(const std::vector<float>& energy, const SphereMesh& mesh, std::uint32_t a,
               std::uint32_t b, float level) {
    if (energy[a] > level) return false;
    std::vector<bool> seen(energy.size(), false);
    std::vector<std::uint32_t> next{a};
    seen[a] = true;
    while (!next.empty()) {
        const std::uint32_t v = next.back();
        next.pop_back();
        if (v == b) return true;
        for (std::size_t k = 0; k < 6; ++k) {
            const std::uint32_t w = mesh.neighbour[v * 6 + k];
            if (seen[w] || energy[w] > level) continue;
            seen[w] = true;
            next.push_back(w);
        }
    }
    return false;
}

TEST(DisconnectivityGraph, EveryMinimumDiesAtItsLowestPass) {
    const SphereMesh mesh = geodesic_sphere(3);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        std::vector<float> energy = random.floats(mesh.size(), 0, 1);
        if (seed % 2) {
            for (float& e : energy) e = std::floor(e * 6) / 6;
        }
        const MergeTree tree = disconnectivity_graph(energy, mesh, 0);
        // By definition: a basin dies at the least energy that links its minimum to a deeper one
        // (or, where equal, to one of a lower id).
        ASSERT_FALSE(tree.basins.empty());
        EXPECT_EQ(tree.basins[0].parent, -1);
        EXPECT_EQ(tree.basins[0].pass, std::numeric_limits<double>::infinity());
        for (std::size_t b = 1; b < tree.basins.size(); ++b) {
            const MergeTree::Basin& basin = tree.basins[b];
            EXPECT_GE(basin.energy, tree.basins[b - 1].energy);
            EXPECT_GT(basin.pass, basin.energy);
            EXPECT_EQ(energy[basin.saddle], basin.pass);
            EXPECT_EQ(energy[basin.minimum], basin.energy);
            float lowest = 9;
            for (std::uint32_t v = 0; v < energy.size(); ++v) {
                const bool elder = energy[v] < energy[basin.minimum] ||
                                   (energy[v] == energy[basin.minimum] && v < basin.minimum);
                if (!elder) continue;
                for (const float level : energy) {
                    if (level < lowest && connected(energy, mesh, basin.minimum, v, level))
                        lowest = level;
                }
            }
            EXPECT_EQ(basin.pass, lowest);
        }
    }
}

TEST(DisconnectivityGraph, GivesTheFloodsLevels) {
    for (const unsigned f : {2U, 5U, 9U}) {
        const SphereMesh mesh = geodesic_sphere(f);
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            test::Random random(seed * 100 + f);
            std::vector<float> energy = random.floats(mesh.size(), 0, 1);
            if (seed % 2) {
                for (float& e : energy) e = std::floor(e * 5) / 5;
            }
            const MergeTree tree = disconnectivity_graph(energy, mesh, 0);
            const auto start = static_cast<std::uint32_t>(random.word() % mesh.size());
            const std::vector<float> flood = oracle::flood(energy, mesh.neighbour, 6, start);
            for (std::uint32_t v = 0; v < mesh.size(); ++v) {
                ASSERT_EQ(tree.minimax(energy, start, v), flood[v])
                    << "f " << f << " seed " << seed << " at " << v;
            }
        }
    }
}

TEST(DisconnectivityGraph, PlateausAreOneBasin) {
    const SphereMesh mesh = geodesic_sphere(8);
    const std::vector<float> flat(mesh.size(), 1.0F);
    EXPECT_EQ(disconnectivity_graph(flat, mesh, 0).basins.size(), 1U);
    test::Random random(3);
    const std::vector<float> noise = random.floats(mesh.size(), 1.0F, 1.001F);
    EXPECT_GT(disconnectivity_graph(noise, mesh, 0).basins.size(), 10U);
    EXPECT_EQ(disconnectivity_graph(noise, mesh, 0.0011).basins.size(), 1U);
    EXPECT_THROW(disconnectivity_graph({}, mesh, 0), Error);
}

TEST(DisconnectivityGraph, ABoxHasSixBasins) {
    const SphereMesh mesh = geodesic_sphere(32);
    std::vector<float> height;
    for (std::size_t v = 0; v < mesh.size(); ++v) {
        height.push_back(0.15F * std::abs(mesh.x[v]) + 0.1F * std::abs(mesh.y[v]) +
                         0.25F * std::abs(mesh.z[v]));
    }
    const MergeTree tree = disconnectivity_graph(height, mesh, 0.01);
    ASSERT_EQ(tree.basins.size(), 6U);
    // On each pair of faces: 0.1, 0.15 and 0.25 m up. The mesh overshoots where it misses a face.
    const double truth[6] = {0.1, 0.1, 0.15, 0.15, 0.25, 0.25};
    for (std::size_t b = 0; b < 6; ++b) EXPECT_NEAR(tree.basins[b].energy, truth[b], 0.008);
}

}  // namespace
}  // namespace topple::physics
