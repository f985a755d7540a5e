// SPDX-License-Identifier: MIT
#include "graph/supports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "host/graph/floor_scene.h"
#include "kernels/device_harness.h"

namespace topple::graph {
namespace {

using test::box;
using test::FloorScene;

// Each primitive is an object by itself; the floor is the ground.
class SupportsOf : public test::EachBackend {
  protected:
    std::vector<Support> supports(FloorScene& scene, double joint = 0) {
        const ContactGraph contacts = scene.contacts(*device);
        const std::vector<double> joints(contacts.pairs.size(), joint);
        std::vector<std::int32_t> object;
        std::vector<Carried> objects;
        for (const physics::MassProperties& body : scene.bodies(*device)) {
            objects.push_back({object.empty(), body.mass_kg});
            object.push_back(static_cast<std::int32_t>(object.size()));
        }
        return find_supports(contacts, joints, object, objects,
                             undersides(scene.cells, object, object.size()));
    }
};
TOPPLE_ON_EACH_BACKEND(SupportsOf);

TEST_P(SupportsOf, AStackAreThoseBelow) {
    FloorScene scene;
    const auto lower = scene.add(box({0, 0, 0}, {0.4, 0.4, 0.3}));
    const auto upper = scene.add(box({0.1, 0.1, 0.3}, {0.3, 0.3, 0.5}));
    const auto found = supports(scene);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].supporter, 0);
    EXPECT_EQ(found[0].supported, lower);
    EXPECT_NEAR(found[0].area_m2, 0.16, 1e-9);
    EXPECT_EQ(found[1].supporter, lower);
    EXPECT_EQ(found[1].supported, upper);
    EXPECT_GT(found[1].probability, 0.7);
}

TEST_P(SupportsOf, AGapThatNoiseLeavesIsBridged) {
    FloorScene scene;
    const auto thing = scene.add(box({0, 0, 0.06}, {0.2, 0.2, 0.3}));
    const auto found = supports(scene);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].supported, thing);
    EXPECT_NEAR(found[0].area_m2, 0.04, 1e-9);
}

TEST_P(SupportsOf, PiecesOfOneThingHardlyCarryEachOther) {
    FloorScene scene;
    scene.add(box({0, 0, 0}, {0.2, 0.2, 0.3}));
    scene.add(box({0, 0, 0.3}, {0.2, 0.2, 0.6}));
    const auto apart = supports(scene, 0), joined = supports(scene, 0.9);
    ASSERT_EQ(apart.size(), 2u);
    EXPECT_LT(joined.back().probability, apart.back().probability - 0.1);
}

// A heavy box on a post: hardly a support, but the only one that there is.
TEST_P(SupportsOf, WhatStandsOnLittleKeepsItsLikeliest) {
    FloorScene scene;
    const auto post = scene.add(box({0.1, 0.1, 0}, {0.2, 0.2, 0.5}));
    const auto thing = scene.add(box({0, 0, 0.5}, {0.3, 0.3, 0.8}));
    const auto found = supports(scene);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[1].supporter, post);
    EXPECT_EQ(found[1].supported, thing);
    EXPECT_GT(found[1].probability, 0.2);
    EXPECT_LT(found[1].probability, 0.5);
}

// Hooks that hang on one another: of each round the likeliest stay, and what carries the ring does.
TEST(Supports, ThreeDoNotHoldEachOtherUp) {
    ContactGraph contacts;
    contacts.primitives = 5;
    contacts.voxel_m = 0.02;
    const auto carries = [&](std::int32_t supporter, std::int32_t supported, double columns) {
        Carrying& c = contacts.carryings.emplace_back();
        c.supporter = supporter;
        c.supported = supported;
        c.area_m2 = columns * contacts.voxel_m * contacts.voxel_m;
    };
    carries(0, 1, 400);
    carries(1, 2, 900);
    carries(2, 3, 700);
    carries(3, 1, 500);  // the least of the round
    carries(3, 4, 600);
    carries(4, 3, 600);  // these two lean together
    const std::vector<std::int32_t> object{0, 1, 2, 3, 4};
    std::vector<Carried> objects(5, Carried{false, 2});
    objects[0].grounded = true;
    const auto found =
        find_supports(contacts, {}, object, objects, std::vector<std::vector<Underside>>(5));
    std::vector<std::array<std::int32_t, 2>> pairs;
    for (const Support& s : found) pairs.push_back({s.supporter, s.supported});
    EXPECT_THAT(pairs,
                ::testing::UnorderedElementsAreArray(std::vector<std::array<std::int32_t, 2>>{
                    {0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 3}}));
}

}  // namespace
}  // namespace topple::graph
