// SPDX-License-Identifier: MIT
#include "physics/basins.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/device_compare.h"
#include "oracle/flood_oracle.h"
#include "oracle/steepest_descent_oracle.h"

namespace topple::physics {
namespace {

// Noise has as many basins as a mesh can; in steps it has plateaus, and saddles that are equal.
void expect_levels_of_flood(const SphereMesh& mesh, const std::vector<float>& height,
                            std::uint32_t start) {
    std::vector<std::uint32_t> down = oracle::steepest_descent(height, mesh.neighbour, 6);
    const Basins basins(height, mesh, down, start);
    const std::vector<float> flood = oracle::flood(height, mesh.neighbour, 6, start);
    for (std::uint32_t v = 0; v < mesh.size(); ++v) ASSERT_EQ(basins.level(v), flood[v]) << v;
    for (std::size_t b = 0; b < basins.minima().size(); ++b)
        ASSERT_EQ(std::max(basins.level_of_minimum(b), height[basins.minima()[b]]),
                  flood[basins.minima()[b]]);
}

TEST(Basins, LevelsAreThoseOfAFlood) {
    for (const unsigned f : {1U, 2U, 5U, 9U, 16U, 33U}) {
        const SphereMesh mesh = geodesic_sphere(f);
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            SCOPED_TRACE(testing::Message() << "f " << f << " seed " << seed);
            test::Random random(seed * 100 + f);
            std::vector<float> height = random.floats(mesh.size(), -1, 1);
            if (seed % 2) {
                for (float& h : height) h = std::floor(h * 5) / 5;
            }
            expect_levels_of_flood(mesh, height,
                                   static_cast<std::uint32_t>(random.word() % mesh.size()));
        }
    }
}

TEST(Basins, LevelsOfAPrismAndOfAPlain) {
    // Height of the centre of a prism with many sides: a ring of basins about a ridge.
    const SphereMesh mesh = geodesic_sphere(16);
    std::vector<float> height;
    for (std::size_t v = 0; v < mesh.size(); ++v) {
        float most = 0;
        for (int n = 0; n < 24; ++n) {
            const double angle = n * 0.2617993877991494;
            most = std::max(most, static_cast<float>(0.1 * std::cos(angle) * mesh.x[v] +
                                                     0.1 * std::sin(angle) * mesh.y[v]));
        }
        height.push_back(most + 0.15F * std::abs(mesh.z[v]));
    }
    expect_levels_of_flood(mesh, height, 0);
    expect_levels_of_flood(mesh, height, static_cast<std::uint32_t>(mesh.size()) / 2);
    const std::vector<float> flat(mesh.size(), 1.0F);
    std::vector<std::uint32_t> down = oracle::steepest_descent(flat, mesh.neighbour, 6);
    const Basins plain(flat, mesh, down, 7);
    for (std::uint32_t v = 0; v < mesh.size(); ++v) ASSERT_EQ(plain.level(v), 1.0F);
}

}  // namespace
}  // namespace topple::physics
