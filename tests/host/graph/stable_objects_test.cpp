// SPDX-License-Identifier: MIT
#include "graph/stable_objects.h"

#include "host/graph/floor_scene.h"
#include "kernels/device_harness.h"

namespace topple::graph {
namespace {

using test::box;
using test::FloorScene;
using testing::ElementsAre;

// Of the options only these are fitted: tests hold what they do, not their values.
GroupingOptions weighing(double standing_weight, double joint_bias = 0, std::uint64_t seed = 1) {
    GroupingOptions options;
    options.seed = seed;
    options.standing_weight = standing_weight;
    options.joint_bias = joint_bias;
    return options;
}

class Objects : public test::EachBackend {
  protected:
    // The floor is surely the room's, all else surely not.
    static ShellOdds shell_of(const FloorScene& scene) {
        ShellOdds shell{std::vector<double>(static_cast<std::size_t>(scene.count), -6),
                        std::vector<bool>(static_cast<std::size_t>(scene.count))};
        shell.log_odds[0] = 6;
        shell.pinned[0] = true;
        return shell;
    }
    Grouping grouped(FloorScene& scene, const std::vector<Joint>& joints,
                     const GroupingOptions& options = weighing(1), unsigned threads = 1) {
        const ContactGraph contacts = scene.contacts(*device);
        return group_primitives(contacts, scene.bodies(*device), joints, shell_of(scene), options,
                                threads);
    }
};
TOPPLE_ON_EACH_BACKEND(Objects);

// A table of a top and four legs, and a cup on it.
struct LaidTable : FloorScene {
    std::int32_t top = add(box({-0.4, -0.3, 0.6}, {0.4, 0.3, 0.64}));
    std::vector<std::int32_t> legs;
    std::int32_t cup = -1;
    LaidTable() {
        for (const double x : {-0.4, 0.36})
            for (const double y : {-0.3, 0.26})
                legs.push_back(add(box({x, y, 0}, {x + 0.04, y + 0.04, 0.6})));
        cup = add(test::cylinder(0.1, 0, 0.04, 0.64, 0.74));
    }
    std::vector<Joint> joints(double legs_odds, double cup_odds) const {
        std::vector<Joint> out;
        for (const std::int32_t leg : legs) out.push_back({0, leg, -4});
        for (const std::int32_t leg : legs) out.push_back({top, leg, legs_odds});
        out.push_back({top, cup, cup_odds});
        return out;
    }
};

TEST_P(Objects, LegsGoWithTheTableAndTheCupStaysFree) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        LaidTable table;
        const Grouping out = grouped(table, table.joints(3, -3), weighing(1, 0, seed));
        EXPECT_THAT(out.group, ElementsAre(-1, 0, 0, 0, 0, 0, 1));
        EXPECT_THAT(out.agreement, testing::Each(1.0));
    }
}

// No leg stands by itself for long, and the top not at all: that is evidence against joints that
// are a little below even. The cup stands on the table whatever happens.
TEST_P(Objects, WhatCannotStandByItselfIsPartOfSomething) {
    LaidTable table;
    EXPECT_THAT(grouped(table, table.joints(3, -0.4)).group, ElementsAre(-1, 0, 0, 0, 0, 0, 1));

    // A lamp's shade that hangs beside its pole.
    FloorScene lamp;
    lamp.add(box({-0.1, -0.1, 0}, {0.1, 0.1, 0.6}));
    lamp.add(box({0.1, -0.1, 0.4}, {0.4, 0.1, 0.5}));
    EXPECT_THAT(grouped(lamp, {{0, 1, -4}, {1, 2, -0.7}}).group, ElementsAre(-1, 0, 0));
    // Where the joint is far below even, the scan has missed what holds it.
    EXPECT_THAT(grouped(lamp, {{0, 1, -4}, {1, 2, -5}}).group, ElementsAre(-1, 0, 1));
    EXPECT_THAT(grouped(lamp, {{0, 1, -4}, {1, 2, -0.7}}, weighing(0)).group,
                ElementsAre(-1, 0, 1));
}

TEST_P(Objects, WhatStandsByItselfStaysApart) {
    FloorScene scene;
    scene.add(box({0, 0, 0}, {0.3, 0.3, 0.2}));
    scene.add(box({0, 0, 0.2}, {0.3, 0.1, 0.4}));
    EXPECT_THAT(grouped(scene, {{0, 1, -4}, {1, 2, -0.4}}).group, ElementsAre(-1, 0, 1));
    EXPECT_THAT(grouped(scene, {{0, 1, -4}, {1, 2, 0.4}}).group, ElementsAre(-1, 0, 0));
    // A bias takes from each joint, one that is alone as well.
    EXPECT_THAT(grouped(scene, {{0, 1, -4}, {1, 2, 0.4}}, weighing(1, -1.2)).group,
                ElementsAre(-1, 0, 1));
    scene.add(box({0.3, 0, 0}, {0.6, 0.3, 0.2}));
    const std::vector<Joint> ring{{0, 1, -4}, {1, 2, 0.4}, {1, 3, 0.4}, {2, 3, 0.4}};
    EXPECT_THAT(grouped(scene, ring).group, ElementsAre(-1, 0, 0, 0));
    EXPECT_THAT(grouped(scene, ring, weighing(1, -1.2)).group, ElementsAre(-1, 0, 1, 2));
}

// A shelf on a wall is the room's, as the model has it; a chair pushed to it is not.
TEST_P(Objects, WhatIsBuiltInGoesWithTheRoom) {
    FloorScene scene;
    scene.add(box({-0.2, -0.2, 0.6}, {0.2, 0.2, 0.64}));
    scene.add(box({-0.2, 0.24, 0}, {0.2, 0.6, 0.7}));
    const ContactGraph contacts = scene.contacts(*device);
    const ShellOdds shell{{6, 2, -4}, {true, false, false}};
    const std::vector<Joint> joints{{0, 1, 0.5}, {0, 2, -4}, {1, 2, -2}};
    const Grouping out =
        group_primitives(contacts, scene.bodies(*device), joints, shell, weighing(1), 1);
    EXPECT_THAT(out.group, ElementsAre(-1, -1, 0));
}

// A board whose foot is 40 cm in front of a wall, or of nothing.
TEST_P(Objects, WhatLeansOnTheWallStands) {
    for (const bool wall : {true, false}) {
        FloorScene scene;
        scene.add([](double x, double y, double z) {
            const double at = 0.4 * (1 - z);  // distance from the wall at this height
            return std::abs(x) < 0.15 && std::abs(y - at) < 0.02 && z > 0 && z < 1;
        });
        scene.add(box({-0.9, -0.06, 0}, {0.9, wall ? -0.02 : -0.04, 1.1}));
        const ContactGraph contacts = scene.contacts(*device);
        const auto c = candidate_of(contacts, scene.bodies(*device), {true, false, wall}, {1});
        const double cost = standing_cost(c, contacts.voxel_m);
        if (wall)
            EXPECT_LT(cost, 0.1);
        else
            EXPECT_GT(cost, 2.9);
    }
}

// Whatever the groups: the model's probability that both are one, or both are the room's.
TEST_P(Objects, PairsHaveTheProbabilitiesOfTheirJoints) {
    LaidTable table;
    const ContactGraph contacts = table.contacts(*device);
    const std::vector<Joint> joints = table.joints(3, -3);
    const ShellOdds shell = shell_of(table);
    const std::vector<double> out = pair_probabilities(contacts, joints, shell);
    const std::vector<double> unknown = pair_probabilities(contacts, {}, shell);
    const auto probability = [](double odds) { return 1 / (1 + std::exp(-odds)); };
    ASSERT_EQ(out.size(), contacts.pairs.size());
    for (std::size_t n = 0; n < contacts.pairs.size(); ++n) {
        const auto joint = std::ranges::find_if(joints, [&](const Joint& j) {
            return j.a == contacts.pairs[n].a && j.b == contacts.pairs[n].b;
        });
        ASSERT_NE(joint, joints.end());
        const double room = probability(joint->a == 0 ? 6 : -6) * probability(-6);
        EXPECT_NEAR(out[n], room + (1 - room) * probability(joint->log_odds), 1e-12);
        // A pair that the model was not asked about is taken for two.
        EXPECT_NEAR(unknown[n], room, 1e-12);
    }
}

// -ln of the share of a normal distribution: the margin over the noise.
TEST(StandingCost, FollowsTheMarginOfTheCentre) {
    physics::Candidate c;
    c.body = test::body(0.001, {0, 0, 0.5});
    c.support_polygon = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};
    const double noise_m = 0.01;
    EXPECT_NEAR(standing_cost(c, noise_m), 0, 1e-9) << "ten standard errors inside";
    c.body.center[0] = 0.1;
    EXPECT_NEAR(standing_cost(c, noise_m), std::log(2), 1e-9) << "on the border";
    c.body.center[0] = 0.09;
    EXPECT_NEAR(standing_cost(c, noise_m), -std::log(0.8413447460685429), 1e-9);
    c.body.center[0] = 0.11;
    EXPECT_NEAR(standing_cost(c, noise_m), -std::log(1 - 0.8413447460685429), 1e-9);
    c.body.center[0] = 0.2;
    EXPECT_NEAR(standing_cost(c, noise_m), -std::log(0.05), 1e-12) << "outside";
    c.support_polygon.clear();
    EXPECT_NEAR(standing_cost(c, noise_m), -std::log(0.05), 1e-12) << "on nothing";
    c.body.mass_kg = 0;
    EXPECT_EQ(standing_cost(c, noise_m), 0) << "nothing there to fall";
    // How high it stands plays no part.
    c = {};
    c.body = test::body(0.001, {0.09, 0, 50});
    c.support_polygon = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};
    EXPECT_NEAR(standing_cost(c, noise_m), -std::log(0.8413447460685429), 1e-9);
}

}  // namespace
}  // namespace topple::graph
