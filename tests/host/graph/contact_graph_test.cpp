// SPDX-License-Identifier: MIT
#include "graph/contact_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/graph/floor_scene.h"
#include "kernels/device_harness.h"

namespace topple::graph {
namespace {

using test::box;

class Contacts : public test::EachBackend {};
TOPPLE_ON_EACH_BACKEND(Contacts);

// The border of a board and a shelf's side is a staircase: columns of the board over the side, and
// of the side over the board, by chance.
TEST_P(Contacts, WhatMeetsSideBySideDoesNotCarry) {
    test::FloorScene scene;
    const auto side = scene.add([](double x, double y, double z) {
        const double jag = std::fmod(std::abs(y), 0.08) < 0.04 ? 0.02 : 0;
        return x > 0.2 && x < 0.24 + (z < 0.52 ? jag : 0) && y > 0 && y < 0.32 && z > 0 && z < 0.8;
    });
    const auto board = scene.add(box({0.24, 0, 0.5}, {0.8, 0.32, 0.54}));
    const ContactGraph graph = scene.contacts(*device);
    EXPECT_TRUE(graph.carriers_of(board).empty());
    ASSERT_EQ(graph.carriers_of(side).size(), 1u);
    EXPECT_EQ(graph.carriers_of(side)[0].supporter, 0);
}

// Of a box seen from the front only its front and top are known: nobody has seen that its rear does
// not stand.
TEST_P(Contacts, WhatNobodySawMayStand) {
    test::FloorScene scene;
    const auto shell = scene.add([](double x, double y, double z) {
        return x > 0 && x < 0.2 && y > 0 && y < 0.2 && z > 0 && z < 0.3 && (y < 0.04 || z > 0.26);
    });
    scene.voxelise();
    const auto depth = [&] {
        const ContactGraph graph = scene.contacts(*device);
        double high = -1;
        for (const auto& p : graph.carriers_of(shell)[0].outline) high = std::max(high, p[1]);
        return high;
    };
    EXPECT_NEAR(depth(), 0.04, 1e-9);
    scene.cells.unseen_below.assign(scene.cells.size(), 0);
    for (std::size_t n = 0; n < scene.cells.size(); ++n)
        if (scene.cells.primitive[n] == shell && scene.cells.k[n] == 13)
            scene.cells.unseen_below[n] = 20;
    EXPECT_NEAR(depth(), 0.2, 1e-9);
}

// A box half over the edge of a post: below the half in the air nobody has seen, but the post has
// ended there.
TEST_P(Contacts, WhatNobodySawCarriesNotBeyondTheSupport) {
    test::FloorScene scene;
    const auto post = scene.add(box({0, 0, 0}, {0.2, 0.2, 0.4}));
    const auto thing = scene.add(box({0.1, 0, 0.4}, {0.3, 0.2, 0.6}));
    scene.voxelise();
    scene.cells.unseen_below.assign(scene.cells.size(), 20);
    const ContactGraph graph = scene.contacts(*device);
    ASSERT_EQ(graph.carriers_of(thing).size(), 1u);
    EXPECT_EQ(graph.carriers_of(thing)[0].supporter, post);
    for (const auto& point : graph.carriers_of(thing)[0].outline) EXPECT_LE(point[0], 0.2 + 1e-9);
}

// Hidden behind another, a thing's foot is unseen: it stands on the floor. Where the floor under it
// is seen, it hangs, and what is near may hold it.
TEST_P(Contacts, AHiddenFootStandsAndASeenGapHangs) {
    test::FloorScene scene;
    const auto thing = scene.add(box({0, 0, 0.2}, {0.2, 0.2, 0.4}));
    const auto wall = scene.add(box({0.26, -0.5, 0}, {0.3, 0.5, 1}));
    scene.voxelise();
    const ContactGraph hanging = scene.contacts(*device);
    EXPECT_TRUE(hanging.carriers_of(thing).empty());
    EXPECT_TRUE(std::ranges::any_of(hanging.pairs, [&](const physics::TouchingPair& p) {
        return p.a == thing && p.b == wall;
    }));
    scene.cells.unseen_below.assign(scene.cells.size(), 0);
    for (std::size_t n = 0; n < scene.cells.size(); ++n)
        if (scene.cells.primitive[n] == thing && scene.cells.k[n] == 10)
            scene.cells.unseen_below[n] = 10;
    const ContactGraph standing = scene.contacts(*device);
    ASSERT_EQ(standing.carriers_of(thing).size(), 1u);
    EXPECT_EQ(standing.carriers_of(thing)[0].supporter, 0);
    EXPECT_NEAR(standing.carriers_of(thing)[0].area_m2, 0.04, 1e-9);
}

// A screen above its table is not fixed to it through air that was seen.
TEST_P(Contacts, AirThatWasSeenIsNoHiddenJoint) {
    test::FloorScene scene;
    const auto table = scene.add(box({-0.4, -0.3, 0}, {0.4, 0.3, 0.4}));
    const auto screen = scene.add(box({-0.2, -0.02, 0.46}, {0.2, 0.02, 0.7}));
    scene.voxelise();
    const auto joined = [&] {
        return std::ranges::any_of(
            scene.contacts(*device).pairs,
            [&](const physics::TouchingPair& p) { return p.a == table && p.b == screen; });
    };
    scene.cells.unseen_below.assign(scene.cells.size(), 0);
    EXPECT_FALSE(joined());
    for (std::size_t n = 0; n < scene.cells.size(); ++n)
        if (scene.cells.primitive[n] == screen && scene.cells.k[n] == 23)
            scene.cells.unseen_below[n] = 3;
    EXPECT_TRUE(joined());
}

// A table seen along x and y is its top and two legs; along z its top hides them.
TEST_P(Contacts, SilhouettesCountEachLineOnce) {
    test::FloorScene scene;
    const auto table = scene.add([](double x, double y, double z) {
        if (std::abs(x) > 0.4 || std::abs(y) > 0.3 || z < 0 || z > 0.44) return false;
        return z > 0.4 || (std::abs(x) > 0.36 && std::abs(y) > 0.26);
    });
    const auto area = scene.contacts(*device).silhouette_m2[table];
    EXPECT_NEAR(area[0], 0.6 * 0.04 + 2 * 0.04 * 0.4, 1e-9);
    EXPECT_NEAR(area[1], 0.8 * 0.04 + 2 * 0.04 * 0.4, 1e-9);
    EXPECT_NEAR(area[2], 0.8 * 0.6, 1e-9);
}

}  // namespace
}  // namespace topple::graph
