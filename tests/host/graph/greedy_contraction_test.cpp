// SPDX-License-Identifier: MIT
#include "graph/greedy_contraction.h"

#include "core/random.h"
#include "device/devices.h"
#include "graph/group_energy.h"
#include "host/physics/solids.h"
#include "testing.h"

namespace topple::graph {
namespace {

using testing::ElementsAre;

std::vector<std::int32_t> contracted(std::int32_t nodes, const std::vector<Joint>& joints) {
    const auto count = static_cast<std::size_t>(nodes);
    return contract_greedily(nodes, joints, std::vector<bool>(count),
                             std::vector<double>(count, 0.0));
}

// The sum of the log-odds within groups, with that of each node to the ground's.
double gain(const std::vector<std::int32_t>& label, const std::vector<Joint>& joints,
            const std::vector<bool>& pinned, const std::vector<double>& to_pinned) {
    const auto of = [&](std::int32_t n) { return label[n]; };
    const auto held = std::ranges::find(pinned, true);
    double sum = 0;
    for (const Joint& j : joints) {
        const bool fixed = pinned[j.a] && pinned[j.b];
        if (!fixed && of(j.a) == of(j.b)) sum += j.log_odds;
    }
    for (std::size_t n = 0; n < label.size(); ++n) {
        if (held != pinned.end() && !pinned[n] &&
            label[n] == of(static_cast<std::int32_t>(held - pinned.begin())))
            sum += to_pinned[n];
    }
    return sum;
}

std::vector<std::int32_t> alone(const std::vector<bool>& pinned) {
    std::vector<std::int32_t> label(pinned.size());
    std::iota(label.begin(), label.end(), 0);
    const auto ground = std::ranges::find(pinned, true) - pinned.begin();
    for (std::size_t n = 0; n < label.size(); ++n)
        if (pinned[n]) label[n] = static_cast<std::int32_t>(ground);
    return label;
}

TEST(GreedyContraction, JoinsWhatIsEvenlyLikelyOrMore) {
    EXPECT_THAT(contracted(4, {{0, 1, 0.1}, {1, 2, -0.1}, {2, 3, 2}}), ElementsAre(0, 0, 2, 2));
    // What is exactly even stays apart.
    EXPECT_THAT(contracted(2, {{0, 1, 0}}), ElementsAre(0, 1));
    EXPECT_THAT(contracted(0, {}), ElementsAre());
}

// Two parts that are sure of a third, but surer that they are not one: the surest goes first, and
// the sum of what is between the groups counts then.
TEST(GreedyContraction, SumsAllThatIsBetweenTwoGroups) {
    EXPECT_THAT(contracted(3, {{0, 1, 2}, {0, 2, 1}, {1, 2, -3}}), ElementsAre(0, 0, 2));
    EXPECT_THAT(contracted(3, {{0, 1, 2}, {0, 2, 1}, {1, 2, -0.5}}), ElementsAre(0, 0, 0));
    // Two weak joints with one group are stronger than one with another.
    EXPECT_THAT(contracted(4, {{0, 1, 5}, {0, 2, 1}, {1, 2, 1}, {2, 3, 1.5}, {0, 3, -9}}),
                ElementsAre(0, 0, 0, 3));
}

TEST(GreedyContraction, OfTiesTheLowestNodesComeFirst) {
    EXPECT_THAT(contracted(3, {{0, 1, 1}, {0, 2, -5}, {1, 2, 1}}), ElementsAre(0, 0, 2));
    EXPECT_THAT(contracted(4, {{0, 3, -9}, {0, 2, 1}, {1, 3, 1}, {1, 2, 1}}),
                ElementsAre(0, 0, 0, 3));
    // Whatever the order in which joints are given.
    EXPECT_THAT(contracted(3, {{1, 2, 1}, {0, 2, -5}, {0, 1, 1}}), ElementsAre(0, 0, 2));
}

TEST(GreedyContraction, PinnedNodesAreOneAndTakeWhatIsTheRooms) {
    const std::vector<bool> pinned{false, true, false, true, false};
    // 1 and 3 are the room's although they are said to be two; 0 is built in by its own odds, 2 by
    // its joints with both; 4 is not, though its joint says so.
    EXPECT_THAT(
        contract_greedily(5, std::vector<Joint>{{1, 2, 1}, {1, 3, -9}, {2, 3, 1}, {3, 4, 2}},
                          pinned, std::vector<double>{0.5, 7, -1.5, 7, -2.5}),
        ElementsAre(0, 0, 0, 0, 4));
    // Without a pinned node the odds for the room count for nothing.
    EXPECT_THAT(contract_greedily(2, std::vector<Joint>{{0, 1, -1}}, {false, false},
                                  std::vector<double>{9, 9}),
                ElementsAre(0, 1));
}

// Against all partitions of small random graphs: never worse than the start, never better than the
// best, and mostly near that; no two groups are left that would be better as one.
TEST(GreedyContraction, IsNearTheBestOfAllPartitions) {
    constexpr std::int32_t nodes = 6;
    double reached = 0, possible = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        std::vector<Joint> joints;
        for (std::int32_t a = 0; a < nodes; ++a) {
            for (std::int32_t b = a + 1; b < nodes; ++b)
                if (random.uniform() < 0.6) joints.push_back({a, b, random.uniform(-3, 3)});
        }
        std::vector<bool> pinned(nodes);
        std::vector<double> to_pinned(nodes);
        for (std::size_t n = 0; n < nodes; ++n) to_pinned[n] = random.uniform(-3, 3);
        if (seed % 2) pinned[2] = pinned[4] = true;

        const auto label = contract_greedily(nodes, joints, pinned, to_pinned);
        const double got = gain(label, joints, pinned, to_pinned);
        EXPECT_GE(got, gain(alone(pinned), joints, pinned, to_pinned) - 1e-9) << seed;
        for (std::int32_t n = 0; n < nodes; ++n) {
            const std::int32_t l = label[n];
            EXPECT_LE(l, n);
            EXPECT_EQ(label[l], l) << "the label is the lowest node";
        }
        for (std::int32_t a = 0; a < nodes; ++a) {
            for (std::int32_t b = a + 1; b < nodes; ++b) {
                std::vector<std::int32_t> merged = label;
                std::ranges::replace(merged, label[b], label[a]);
                EXPECT_LE(gain(merged, joints, pinned, to_pinned), got + 1e-9) << seed;
            }
        }
        // All labellings with six labels hold each partition at least once.
        double best = 0;
        std::vector<std::int32_t> all(nodes, 0);
        for (std::size_t at = 0; at < nodes;) {
            if (!pinned[2] || all[2] == all[4])
                best = std::max(best, gain(all, joints, pinned, to_pinned));
            for (at = 0; at < nodes && ++all[at] == nodes; ++at) all[at] = 0;
        }
        EXPECT_LE(got, best + 1e-9) << seed;
        reached += got;
        possible += best;
    }
    EXPECT_GT(reached, 0.9 * possible);
}

TEST(GreedyContraction, ContractsALongChain) {
    constexpr std::int32_t nodes = 20000;
    std::vector<Joint> joints;
    for (std::int32_t n = 0; n + 1 < nodes; ++n) joints.push_back({n, n + 1, 1.0});
    EXPECT_THAT(contracted(nodes, joints), testing::Each(0));
}

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
        return energy_of({nodes, pinned});
    }
    double energy_of(const GroupQuery& query) const {
        const auto device = device::open_native(1);
        GroupEnergy energy(*device, contacts, bodies, joints, shell, standing_weight);
        double out = 0;
        energy.of(std::span(&query, 1), std::span(&out, 1));
        return out;
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
    const auto device = device::open_native(1);
    GroupEnergy energy(*device, tower.contacts, tower.bodies, tower.joints, tower.shell,
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
        EXPECT_DOUBLE_EQ(value, tower.energy_of(query));
        EXPECT_LE(callbacks.at_least[0](query, -INFINITY), value) << bits;
    }
}

}  // namespace
}  // namespace topple::graph
