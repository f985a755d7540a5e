// SPDX-License-Identifier: MIT
#include "geometry/fragments.h"
#include "host/geometry/split_scenes.h"
#include "testing.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;
using scenes::Builder;
using scenes::Majority;
using scenes::majority;

PrimitiveSet merged(const Surfels& surfels, const FreeSpace& free = {}) {
    ThreadPool threads(2);
    return merge_convex(surfels, split(surfels, threads), {0, 0, 1}, free, threads);
}

// Bodies 0, 1 ... keep these shares of theirs under one label each, no two under the same.
void expect_apart(const Builder& scene, const std::vector<double>& least_share,
                  const FreeSpace& free = {}) {
    const Surfels surfels = scene.surfels();
    const PrimitiveSet primitives = merged(surfels, free);
    std::set<std::int32_t> ids;
    for (std::size_t body = 0; body < least_share.size(); ++body) {
        const Majority of = majority(scene, surfels, primitives.label, static_cast<int>(body));
        EXPECT_GT(of.share, least_share[body]) << "body " << body;
        ids.insert(of.label);
    }
    EXPECT_EQ(ids.size(), least_share.size());
}

TEST(Merge, NothingGivesNothing) {
    Surfels none;
    none.cell_m = 0.02;
    none.neighbour_first = {0};
    const PrimitiveSet primitives = merged(none);
    EXPECT_TRUE(primitives.label.empty());
    EXPECT_TRUE(primitives.regions.empty());
}

TEST(Merge, BodiesStayApartAndWhole) {
    struct Face {
        int body;
        Vector3d corner, u, v;
    };
    struct Box {
        int body;
        Vector3d low, size;
    };
    const struct {
        const char* what;
        double noise_m;
        std::vector<Box> boxes;
        std::vector<Face> faces;
        std::vector<double> least_share;
        double cell_m = 0.02;
    } cases[] = {
        {"a box", 0.002, {{0, {0, 0, 0}, {0.4, 0.3, 0.5}}}, {}, {0.97}},
        {"floor and walls of a room",
         0.003,
         {},
         {{0, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}},
          {1, {0, 0, 0}, {0, 2, 0}, {0, 0, 2}},
          {2, {0, 0, 0}, {0, 0, 2}, {2, 0, 0}}},
         {0.5, 0.5, 0.5}},
        {"boxes of equal height on a floor",
         0,
         {{1, {-0.4, 0, 0}, {0.3, 0.3, 0.3}}, {2, {0.1, 0, 0}, {0.3, 0.3, 0.3}}},
         {{0, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}},
         {0.5, 0.9, 0.9}},
        {"boards of a shelf: the air between is thin, too, but their faces look at each other",
         0,
         {},
         {{0, {0, 0, 0.46}, {1, 0, 0}, {0, 0.4, 0}}, {1, {0, 0, 0.5}, {0, 0.4, 0}, {1, 0, 0}}},
         {0.5, 0.5}},
        {"a table seen in pieces",
         0,
         {{1, {0, 0.95, 0.72}, {1, 0.4, 0.5}}},
         {{0, {0, 0, 0.7}, {1, 0, 0}, {0, 1, 0}}, {0, {0, 1.3, 0.7}, {1, 0, 0}, {0, 1, 0}}},
         {0.95, 0.5}},
        {"backs of two shelves, one plane just as a wall's pieces are",
         0,
         {{2, {0.02, 0.95, 0}, {0.4, 0.4, 2.0}}},
         {{0, {0, 0, 0}, {0, 1, 0}, {0, 0, 2}}, {1, {0, 1.3, 0}, {0, 1, 0}, {0, 0, 2}}},
         {0.5, 0.5, 0.5}},
        {"legs under the very corners of a seat",
         0.002,
         {{0, {0, 0, 0.42}, {0.44, 0.44, 0.05}},
          {1, {0, 0, 0}, {0.05, 0.05, 0.42}},
          {2, {0.39, 0, 0}, {0.05, 0.05, 0.42}},
          {3, {0, 0.39, 0}, {0.05, 0.05, 0.42}}},
         {{0, {0, 0, 0.42}, {0, 0.44, 0}, {0.44, 0, 0}}},
         {0.8, 0.8, 0.8, 0.8},
         0.015},
        {"arms of a sofa that end in one plane with its seat",
         0.003,
         {{1, {0, 0, 0.42}, {0.2, 0.8, 0.2}}, {2, {1.4, 0, 0.42}, {0.2, 0.8, 0.2}}},
         {{0, {0.2, 0, 0.42}, {1.2, 0, 0}, {0, 0.8, 0}},
          {0, {0, 0, 0}, {1.6, 0, 0}, {0, 0, 0.42}},
          {0, {0, 0.8, 0}, {0, -0.8, 0}, {0, 0, 0.42}},
          {0, {1.6, 0, 0}, {0, 0.8, 0}, {0, 0, 0.42}}},
         {0.8, 0.7, 0.7}},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        Builder scene;
        scene.cell_m = c.cell_m;
        scene.noise_m = c.noise_m;
        for (const Face& f : c.faces) scene.face(f.corner, f.u, f.v, f.body);
        for (const Box& b : c.boxes) scene.box(b.low, b.size, b.body);
        expect_apart(scene, c.least_share);
    }
}

TEST(Merge, WhatStandsOnATableStaysApart) {
    Builder scene;
    scene.noise_m = 0.002;
    scene.box({-0.8, -0.5, 0.7}, {1.6, 1, 0.05}, 0);
    scene.box({-0.5, -0.2, 0.75}, {0.25, 0.2, 0.2}, 1);
    scene.tube({0.4, 0, 0.75}, 0.05, 0.2, true, 2);
    expect_apart(scene, {0.85, 0.85, 0.85});
}

// Of a leg under a table only the two outer sides are seen: nothing but the space beside it, which
// the sensor saw through, tells it from the table.
TEST(Merge, ALegSeenFromOutsideStaysApartFromItsTable) {
    Builder scene;
    scene.noise_m = 0.002;
    scene.face({0, 0, 0.75}, {1.2, 0, 0}, {0, 0.7, 0}, 0);
    scene.face({0, 0, 0.7}, {1.2, 0, 0}, {0, 0, 0.05}, 0);
    scene.face({1.2, 0, 0.7}, {0, 0.7, 0}, {0, 0, 0.05}, 0);
    scene.face({1.09, 0.04, 0}, {0.07, 0, 0}, {0, 0, 0.7}, 1);
    scene.face({1.16, 0.04, 0}, {0, 0.07, 0}, {0, 0, 0.7}, 1);
    scene.face({-0.5, 0.5, 0}, {2, 0, 0}, {0, 0, 0.65}, 2);  // what is seen below the table
    const PointCloud cloud = test::cloud_of(scene.points);
    const Surfels s = scene.surfels();
    const Vec3 eye{1.8, -1.2, 1.0};
    ThreadPool threads(2);
    expect_apart(scene, {0.9, 0.9}, FreeSpace(s, cloud, {&eye, 1}, {}, threads));
}

TEST(Merge, IdsFallInSizeAndCoverTheRegions) {
    Builder scene;
    scene.noise_m = 0.002;
    scene.face({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    scene.box({0, 0, 0}, {0.2, 0.2, 0.2}, 1);
    scene.ball({-0.5, -0.5, 0.1}, 0.1, 2);
    const PrimitiveSet primitives = merged(scene.surfels());
    std::vector<std::uint64_t> count(primitives.regions.size(), 0);
    for (const std::int32_t label : primitives.label)
        if (label >= 0) ++count[label];
    for (std::size_t k = 1; k < count.size(); ++k) EXPECT_GE(count[k - 1], count[k]);
    EXPECT_EQ(primitives.model.size(), count.size());
    EXPECT_EQ(primitives.model.front(), "plane");
    EXPECT_EQ(primitives.model.at(1), "merged");
}

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
            test::add(s, 0.02F * static_cast<float>(c[0]), 0.02F * static_cast<float>(c[1]),
                      0.02F * static_cast<float>(c[2]));
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
