// SPDX-License-Identifier: MIT
#include "graph/stable_objects.h"

#include "errors.h"
#include "graph/group_stances.h"
#include "host/graph/floor_scene.h"
#include "physics/tipping.h"
#include "topple/kernel_testing/each_backend.h"

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
                     const GroupingOptions& options = weighing(1)) {
        const ContactGraph contacts = scene.contacts(*device);
        return group_primitives(*device, contacts, scene.bodies(*device), joints, shell_of(scene),
                                options);
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
        group_primitives(*device, contacts, scene.bodies(*device), joints, shell, weighing(1));
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
        const auto bodies = scene.bodies(*device);
        const std::vector<bool> shell{true, false, wall};
        const GroupQuery board{{1}, false};
        const Stance stance =
            GroupStances(*device, contacts, bodies, shell).of(std::span(&board, 1))[0];
        const auto candidate = candidate_of(contacts, bodies, shell, {1});
        EXPECT_NEAR(stance.margin_m,
                    physics::footing(candidate.support_polygon, candidate.body.center[0],
                                     candidate.body.center[1])
                        .margin_m,
                    1.0 / 40);
        const double cost = standing_cost(stance, contacts.voxel_m);
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
    constexpr double noise_m = 0.01, half = 0.6931471805599453, one_sigma = 0.8413447460685429;
    const auto cost = [&](double margin_m, double height_m, double level = 0) {
        return standing_cost({1, height_m, margin_m}, noise_m, level);
    };
    EXPECT_NEAR(cost(0.1, 0.5), 0, 1e-9) << "ten standard errors inside";
    EXPECT_NEAR(cost(0, 0.5), half, 1e-9) << "on the border";
    EXPECT_NEAR(cost(0.01, 0.5), -std::log(one_sigma), 1e-9);
    EXPECT_NEAR(cost(-0.01, 0.5), -std::log(1 - one_sigma), 1e-9);
    EXPECT_NEAR(cost(-0.1, 0.5), -std::log(0.05), 1e-12) << "outside";
    EXPECT_NEAR(standing_cost({1, 0.5}, noise_m), -std::log(0.05), 1e-12) << "on nothing";
    EXPECT_EQ(standing_cost({}, noise_m), 0) << "nothing there to fall";
    EXPECT_NEAR(cost(0.01, 50), -std::log(one_sigma), 1e-9) << "how high plays no part at W = 0";
    // At W just what it takes to tip it over its border: even.
    const double level = std::hypot(0.5, 0.1) / 0.5 - 1;
    EXPECT_NEAR(cost(0.1, 0.5, level), half, 1e-9);
    EXPECT_LT(cost(0.1, 0.1, level), cost(0.1, 0.5, level)) << "what is lower stays";
}

// Fig. 7c: with a larger disturbance the chair, then the table is fixed to the floor.
TEST_P(Objects, MoreIsFixedToTheFloorAtALargerDisturbance) {
    FloorScene scene;
    scene.add(box({-0.6, -0.4, 0}, {0.6, 0.4, 0.7}));    // the table
    scene.add(box({0.9, -0.12, 0}, {1.14, 0.12, 0.8}));  // the chair
    ShellOdds shell = shell_of(scene);
    shell.log_odds = {6, 0, 0};
    std::vector<std::vector<std::int32_t>> groups;
    for (const double level : {0.0, 0.1, 1.0}) {
        GroupingOptions options = weighing(1);
        options.stability_level = level;
        groups.push_back(group_primitives(*device, scene.contacts(*device), scene.bodies(*device),
                                          std::vector<Joint>{{0, 1, -1}, {0, 2, -1}}, shell,
                                          options)
                             .group);
    }
    EXPECT_THAT(groups[0], ElementsAre(-1, 0, 1));
    EXPECT_THAT(groups[1], ElementsAre(-1, 0, -1));
    EXPECT_THAT(groups[2], ElementsAre(-1, -1, -1));
}

// Support functions in 64 directions against polygons.
TEST_P(Objects, MarginsOfGroupsAreThoseOfTheirPolygons) {
    LaidTable table;
    const ContactGraph contacts = table.contacts(*device);
    const auto bodies = table.bodies(*device);
    const std::vector<bool> shell{true, false, false, false, false, false, false};
    GroupStances stances(*device, contacts, bodies, shell);
    std::vector<GroupQuery> groups;
    for (unsigned bits = 1; bits < 64; ++bits) {
        groups.emplace_back();
        for (std::int32_t n = 0; n < 6; ++n)
            if (bits >> n & 1U) groups.back().nodes.push_back(n + 1);
    }
    const std::vector<Stance> found = stances.of(groups);
    for (std::size_t n = 0; n < groups.size(); ++n) {
        const auto c = candidate_of(contacts, bodies, shell, groups[n].nodes);
        EXPECT_NEAR(found[n].mass_kg, c.body.mass_kg, 1e-9);
        EXPECT_NEAR(found[n].height_m, c.body.center[2] - c.support_height_m, 1e-9);
        const double margin =
            physics::footing(c.support_polygon, c.body.center[0], c.body.center[1]).margin_m;
        EXPECT_GE(found[n].margin_m, margin - 1e-5);
        EXPECT_LE(found[n].margin_m, margin + 0.001 * std::abs(margin) + 1.0 / 40);
    }
}

}  // namespace
}  // namespace topple::graph
