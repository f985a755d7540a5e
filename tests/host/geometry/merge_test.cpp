// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "clouds.h"
#include "host/geometry/split_scenes.h"

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

TEST(Merge, ABoxIsOnePrimitive) {
    Builder scene;
    scene.noise_m = 0.002;
    scene.box({0, 0, 0}, {0.4, 0.3, 0.5}, 0);
    expect_apart(scene, {0.97});
    EXPECT_EQ(merged(scene.surfels()).model.front(), "merged");
}

TEST(Merge, WhatStandsOnATableStaysApart) {
    Builder scene;
    scene.noise_m = 0.002;
    scene.box({-0.8, -0.5, 0.7}, {1.6, 1, 0.05}, 0);
    scene.box({-0.5, -0.2, 0.75}, {0.25, 0.2, 0.2}, 1);
    scene.tube({0.4, 0, 0.75}, 0.05, 0.2, true, 2);
    expect_apart(scene, {0.85, 0.85, 0.85});
}

TEST(Merge, FloorAndWallsOfARoomStayApart) {
    Builder scene;
    scene.noise_m = 0.003;
    scene.face({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    scene.face({0, 0, 0}, {0, 2, 0}, {0, 0, 2}, 1);
    scene.face({0, 0, 0}, {0, 0, 2}, {2, 0, 0}, 2);
    expect_apart(scene, {0.5, 0.5, 0.5});
}

TEST(Merge, BoxesOfEqualHeightStayApart) {
    Builder scene;
    scene.face({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    scene.box({-0.4, 0, 0}, {0.3, 0.3, 0.3}, 1);
    scene.box({0.1, 0, 0}, {0.3, 0.3, 0.3}, 2);
    expect_apart(scene, {0.5, 0.9, 0.9});
}

// The air between a shelf's boards is thin too, but their faces look at each other.
TEST(Merge, FacesThatLookAtEachOtherStayApart) {
    Builder scene;
    scene.face({0, 0, 0.46}, {1, 0, 0}, {0, 0.4, 0}, 0);
    scene.face({0, 0, 0.5}, {0, 0.4, 0}, {1, 0, 0}, 1);
    expect_apart(scene, {0.5, 0.5});
}

TEST(Merge, ATableSeenInPiecesIsOne) {
    Builder scene;
    scene.face({0, 0, 0.7}, {1, 0, 0}, {0, 1, 0}, 0);
    scene.face({0, 1.3, 0.7}, {1, 0, 0}, {0, 1, 0}, 0);
    scene.box({0, 0.95, 0.72}, {1, 0.4, 0.5}, 1);
    expect_apart(scene, {0.95, 0.5});
}

// The backs of two shelves are one plane just as a wall's pieces are.
TEST(Merge, UprightPiecesOfOnePlaneStayApart) {
    Builder scene;
    scene.face({0, 0, 0}, {0, 1, 0}, {0, 0, 2}, 0);
    scene.face({0, 1.3, 0}, {0, 1, 0}, {0, 0, 2}, 1);
    scene.box({0.02, 0.95, 0}, {0.4, 0.4, 2.0}, 2);
    expect_apart(scene, {0.5, 0.5, 0.5});
}

// Legs under the very corners of a seat: its sides and theirs are one plane.
TEST(Merge, LegsFlushWithASeatStayApart) {
    Builder scene;
    scene.cell_m = 0.015;
    scene.noise_m = 0.002;
    scene.box({0, 0, 0.42}, {0.44, 0.44, 0.05}, 0);
    scene.face({0, 0, 0.42}, {0, 0.44, 0}, {0.44, 0, 0}, 0);
    scene.box({0, 0, 0}, {0.05, 0.05, 0.42}, 1);
    scene.box({0.39, 0, 0}, {0.05, 0.05, 0.42}, 2);
    scene.box({0, 0.39, 0}, {0.05, 0.05, 0.42}, 3);
    expect_apart(scene, {0.8, 0.8, 0.8, 0.8});
}

// The arms of a sofa end in one plane with its seat.
TEST(Merge, ArmsFlushWithASofaStayApart) {
    Builder scene;
    scene.noise_m = 0.003;
    scene.face({0.2, 0, 0.42}, {1.2, 0, 0}, {0, 0.8, 0}, 0);
    scene.face({0, 0, 0}, {1.6, 0, 0}, {0, 0, 0.42}, 0);
    scene.face({0, 0.8, 0}, {0, -0.8, 0}, {0, 0, 0.42}, 0);
    scene.face({1.6, 0, 0}, {0, 0.8, 0}, {0, 0, 0.42}, 0);
    scene.box({0, 0, 0.42}, {0.2, 0.8, 0.2}, 1);
    scene.box({1.4, 0, 0.42}, {0.2, 0.8, 0.2}, 2);
    expect_apart(scene, {0.8, 0.7, 0.7});
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
}

}  // namespace
}  // namespace topple::geometry
