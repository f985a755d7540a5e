// SPDX-License-Identifier: MIT
#include "geometry/split.h"

#include <gtest/gtest.h>

#include "host/geometry/split_scenes.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;
using scenes::Builder;
using scenes::majority;

TEST(Split, NothingGivesNothing) {
    Surfels none;
    none.cell_m = 0.02;
    none.neighbour_first = {0};
    const Regions regions = split(none);
    EXPECT_TRUE(regions.label.empty());
    EXPECT_TRUE(regions.regions.empty());
}

TEST(Split, OnePointHasNoRegion) {
    Builder scene;
    scene.point({1, 2, 3}, {0, 0, 1}, 0);
    const Regions regions = split(scene.surfels());
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
    const Regions regions = split(s);
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
    const Regions regions = split(s);
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
    const Regions regions = split(s);
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
    const Regions regions = split(s);
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
    const Regions regions = split(s);
    std::vector<std::uint64_t> count(regions.regions.size(), 0);
    for (const std::int32_t label : regions.label) {
        ASSERT_LT(label, static_cast<std::int32_t>(count.size()));
        if (label >= 0) ++count[label];
    }
    for (std::size_t k = 0; k < count.size(); ++k) EXPECT_EQ(count[k], regions.regions[k].surfels);
    EXPECT_EQ(split(s).label, regions.label);
}

}  // namespace
}  // namespace topple::geometry
