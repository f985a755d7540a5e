// SPDX-License-Identifier: MIT
#include "geometry/fragments.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <map>

namespace topple::geometry {
namespace {

using Cell = std::array<std::int32_t, 3>;

// Surfels in given cells, each with a label of its own choice.
struct FragmentedScene {
    std::map<Cell, std::int32_t> label;
    std::int32_t labels = 0;

    Surfels surfels() const {
        Surfels s;
        s.cell_m = 0.02;
        s.neighbour_first = {0};
        for (const auto& [c, l] : label) {
            s.x.push_back(0.02F * static_cast<float>(c[0]));
            s.y.push_back(0.02F * static_cast<float>(c[1]));
            s.z.push_back(0.02F * static_cast<float>(c[2]));
            std::uint32_t m = 0;
            for (const auto& [d, other] : label) {
                const bool near = std::abs(c[0] - d[0]) <= 1 && std::abs(c[1] - d[1]) <= 1 &&
                                  std::abs(c[2] - d[2]) <= 1;
                if (near && c != d) s.neighbours.push_back(m);
                ++m;
            }
            s.neighbour_first.push_back(static_cast<std::uint32_t>(s.neighbours.size()));
        }
        return s;
    }
    PrimitiveSet primitives() const {
        PrimitiveSet p;
        for (const auto& [c, l] : label) p.label.push_back(l);
        p.model.assign(static_cast<std::size_t>(labels), "plane");
        for (std::int32_t l = 0; l < labels; ++l) p.regions.push_back({l});
        // All faces are the floor's plane, within a centimetre.
        Region floor;
        floor.model.coefficients[3] = 1;
        floor.residual_m = 0.01;
        p.faces.label = p.label;
        p.faces.regions.assign(static_cast<std::size_t>(labels), floor);
        return p;
    }
};

FragmentedScene floor_of_20() {
    FragmentedScene scene;
    for (std::int32_t x = 0; x < 20; ++x)
        for (std::int32_t y = 0; y < 20; ++y) scene.label[{x, y, 0}] = 0;
    scene.labels = 1;
    return scene;
}

TEST(Fragments, PiecesOfAThinLegAreOnePrimitive) {
    FragmentedScene scene = floor_of_20();
    for (std::int32_t z = 1; z <= 16; ++z) scene.label[{10, 10, z}] = z < 8 ? 1 : z < 12 ? -1 : 2;
    scene.labels = 3;
    PrimitiveSet primitives = scene.primitives();
    absorb_fragments(scene.surfels(), 36, primitives);
    ASSERT_EQ(primitives.model.size(), 2u);
    EXPECT_EQ(primitives.model[1], "merged");
    EXPECT_EQ(primitives.regions[1], (std::vector<std::int32_t>{1, 2}));
    std::size_t n = 0;
    for (const auto& [c, l] : scene.label) EXPECT_EQ(primitives.label[n++], c[2] > 0 ? 1 : 0);
}

TEST(Fragments, NoiseAlongACreaseJoinsWhatItLiesOn) {
    FragmentedScene scene = floor_of_20();
    for (std::int32_t x = 0; x < 20; ++x) scene.label[{x, 5, 1}] = 1;
    scene.labels = 2;
    PrimitiveSet primitives = scene.primitives();
    absorb_fragments(scene.surfels(), 50, primitives);
    ASSERT_EQ(primitives.model.size(), 1u);
    for (const std::int32_t l : primitives.label) EXPECT_EQ(l, 0);
}

TEST(Fragments, AFlatThingThatStandsOutOfTheNoiseStays) {
    FragmentedScene scene = floor_of_20();
    for (std::int32_t x = 4; x < 8; ++x)
        for (std::int32_t y = 4; y < 8; ++y) scene.label[{x, y, 2}] = 1;
    for (std::int32_t x = 4; x < 8; ++x) scene.label[{x, 4, 1}] = 1;
    scene.labels = 2;
    PrimitiveSet primitives = scene.primitives();
    absorb_fragments(scene.surfels(), 36, primitives);
    EXPECT_EQ(primitives.model.size(), 2u);
}

TEST(Fragments, AFewSurfelsThatTouchNothingAreUnassigned) {
    FragmentedScene scene = floor_of_20();
    for (std::int32_t z = 10; z < 17; ++z) scene.label[{3, 3, z}] = 1;
    scene.labels = 2;
    PrimitiveSet primitives = scene.primitives();
    absorb_fragments(scene.surfels(), 36, primitives);
    ASSERT_EQ(primitives.model.size(), 1u);
    std::size_t n = 0;
    for (const auto& [c, l] : scene.label) EXPECT_EQ(primitives.label[n++], c[2] > 0 ? -1 : 0);
}

}  // namespace
}  // namespace topple::geometry
