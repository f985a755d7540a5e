// SPDX-License-Identifier: MIT
#include "graph/group_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/physics/solids.h"

namespace topple::graph {
namespace {

// Node 0 is the room's. A tower of three boxes of 0.2 m, 1 to 3, of which 3 reaches so far beyond
// 2 that it would fall; 4 hangs in the air, where it would balance 3.
struct Tower {
    ContactGraph contacts;
    std::vector<physics::MassProperties> bodies;
    std::vector<Joint> joints{{0, 1, -2}, {1, 2, -0.5}, {1, 4, 0.25}, {2, 3, 0.75}, {3, 4, 1.5}};
    ShellOdds shell{{6, -3, -4, -5, 1.25}, {true, false, false, false, false}};
    double standing_weight = 2;

    static std::vector<std::array<double, 2>> square(double x, double width) {
        return physics::convex_polygon({{x, 0}, {x + width, 0}, {x + width, 0.2}, {x, 0.2}});
    }
    Tower() {
        contacts.primitives = 5;
        contacts.voxel_m = 0.02;
        contacts.carryings = {{0, 1, 0.04, 0, square(0, 0.2)},
                              {1, 2, 0.04, 0.2, square(0, 0.2)},
                              {2, 3, 0.04, 0.4, square(0, 0.2)}};
        bodies = {test::body(1, {0, 0, -0.5}), test::body(0.008, {0.1, 0.1, 0.1}),
                  test::body(0.008, {0.1, 0.1, 0.3}), test::body(0.008, {-0.08, 0.1, 0.5}),
                  test::body(0.008, {0.28, 0.1, 0.5})};
    }
    double energy(const Group& nodes, bool pinned = false) const {
        return GroupEnergy(contacts, bodies, joints, shell, standing_weight)({nodes, pinned});
    }
};

const double falls = -std::log(0.05);  // what standing costs most

TEST(GroupEnergy, SumsTheOddsOfTheJointsWithin) {
    const Tower tower;
    EXPECT_DOUBLE_EQ(tower.energy({}), 0);
    // All stands well: next to no cost.
    EXPECT_NEAR(tower.energy({1}), 0, 1e-3);
    EXPECT_NEAR(tower.energy({1, 2}), 0.5, 1e-3);
    // The three together have their centre at x = 0.04 above the lowest's support.
    EXPECT_NEAR(tower.energy({1, 2, 3}), 0.5 - 0.75, 0.1);
}

TEST(GroupEnergy, WhatFallsCostsItsWeightAtMost) {
    Tower tower;
    EXPECT_NEAR(tower.energy({3}), 2 * falls, 1e-9) << "outside of its support by four voxels";
    EXPECT_NEAR(tower.energy({4}), 2 * falls, 1e-9) << "on nothing";
    EXPECT_NEAR(tower.energy({3, 4}), -1.5, 1e-3) << "both together balance on 2";
    tower.standing_weight = 0;
    EXPECT_DOUBLE_EQ(tower.energy({4}), 0);
}

TEST(GroupEnergy, TheGroundWeighsWhatIsTheRoomsInsteadOfStanding) {
    const Tower tower;
    EXPECT_DOUBLE_EQ(tower.energy({0}, true), 0) << "pinned: nothing to weigh";
    EXPECT_DOUBLE_EQ(tower.energy({0, 4}, true), -1.25);
    EXPECT_DOUBLE_EQ(tower.energy({0, 1, 4}, true), -1.25 + 3 + 2 - 0.25);
}

TEST(GroupEnergy, TheRoomIsOneWhateverItsJointsSay) {
    Tower tower;
    tower.shell.pinned[1] = true;
    EXPECT_DOUBLE_EQ(tower.energy({0, 1}, true), 0);
    EXPECT_DOUBLE_EQ(tower.energy({0, 1, 2}, true), 4 + 0.5);
}

TEST(GroupEnergy, ItsBoundIsNeverAboveIt) {
    const Tower tower;
    const GroupEnergy energy(tower.contacts, tower.bodies, tower.joints, tower.shell,
                             tower.standing_weight);
    const GroupEnergies callbacks = energy.callbacks();
    ASSERT_EQ(callbacks.at_least.size(), 1u);
    for (unsigned bits = 1; bits < 32; ++bits) {
        GroupQuery query;
        for (std::int32_t n = 0; n < 5; ++n)
            if (bits >> n & 1u) query.nodes.push_back(n);
        query.pinned = bits & 1u;
        double value = 0;
        callbacks.of(std::span(&query, 1), std::span(&value, 1));
        EXPECT_DOUBLE_EQ(value, energy(query));
        EXPECT_LE(callbacks.at_least[0](query, -INFINITY), value) << bits;
    }
}

}  // namespace
}  // namespace topple::graph
