// SPDX-License-Identifier: MIT
#include "lab/evaluation/groupings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "device/devices.h"
#include "lab/evaluation/greedy.h"
#include "topple/error.h"

namespace topple::evaluation {
namespace {

using graph::Edge;
using graph::Group;
using graph::GroupQuery;

EnergyOf each(double (*energy)(const GroupQuery&)) {
    return [energy](std::span<const GroupQuery> queries, std::span<double> out) {
        for (std::size_t n = 0; n < queries.size(); ++n) out[n] = energy(queries[n]);
    };
}

const std::vector<Edge> chain{{0, 1}, {1, 2}, {2, 3}, {3, 4}};

TEST(Greedy, JoinsWhatLowersTheEnergyMostFirst) {
    // 1 and 2 belong together, and 0 would join either of them but not both.
    const auto energy = [](const GroupQuery& q) {
        if (q.nodes == Group{1, 2}) return -3.0;
        if (q.nodes == Group{0, 1}) return -1.0;
        return q.nodes.size() == 1 ? 0.0 : 5.0;
    };
    const GreedyPartition found = greedy_merges(5, chain, std::vector<bool>(5), each(energy));
    EXPECT_EQ(found.label, (std::vector<std::int32_t>{0, 1, 1, 2, 3}));
    EXPECT_EQ(found.energy, -3);
}

TEST(Greedy, StopsInAMinimumThatNoSingleJoinLeaves) {
    // All five together are best by far, but every join of two costs.
    const auto energy = [](const GroupQuery& q) {
        return q.nodes.size() == 5 ? -100.0 : static_cast<double>(q.nodes.size() - 1);
    };
    const GreedyPartition found = greedy_merges(5, chain, std::vector<bool>(5), each(energy));
    EXPECT_EQ(found.label, (std::vector<std::int32_t>{0, 1, 2, 3, 4}));
    EXPECT_EQ(found.energy, 0);
}

TEST(Greedy, KeepsThePinnedTogetherAndJoinsOnlyWhatTouches) {
    // Everything wants to be one; 4 touches nothing.
    const auto energy = [](const GroupQuery& q) {
        EXPECT_EQ(q.pinned, std::ranges::count(q.nodes, 0) + std::ranges::count(q.nodes, 3) > 0);
        return -static_cast<double>(q.nodes.size() * q.nodes.size());
    };
    const std::vector<Edge> edges{{0, 1}, {3, 2}};
    const GreedyPartition found =
        greedy_merges(5, edges, {true, false, false, true, false}, each(energy));
    EXPECT_EQ(found.label, (std::vector<std::int32_t>{-1, -1, -1, -1, 0}));
    EXPECT_EQ(found.energy, -17);
    EXPECT_TRUE(greedy_merges(0, {}, {}, each(energy)).label.empty());
}

// Labels drawn from known weights: the fit finds them to within four standard errors, which for
// 20000 joints of these features are below 0.1 but for the constant.
TEST(JointClassifier, FitFindsTheWeightsThatMadeTheLabels) {
    topple::Random random(5);
    const JointWeights truth{0.5, 1, -2, 0, 1.5, 0, -1, 0.7, -0.4};
    std::vector<JointFeatures> joints;
    std::vector<bool> fixed;
    for (int n = 0; n < 20000; ++n) {
        JointFeatures x;
        x[0] = 1;
        for (std::size_t k = 1; k < x.size(); ++k) x[k] = 2 * random.uniform() - 1;
        joints.push_back(x);
        fixed.push_back(random.uniform() < probability(truth, x));
    }
    const JointWeights found = fit_joints(joints, fixed);
    for (std::size_t k = 0; k < truth.size(); ++k) EXPECT_NEAR(found[k], truth[k], 0.15) << k;
    EXPECT_THROW(fit_joints(joints, {}), Error);
    EXPECT_EQ(fit_joints({}, {}), JointWeights{});
}

// Joints that a line divides: the ridge keeps the weights finite, and every joint is told.
TEST(JointClassifier, FitOfWhatCanBeDividedIsFinite) {
    std::vector<JointFeatures> joints;
    std::vector<bool> fixed;
    for (int n = 0; n < 50; ++n) {
        JointFeatures x{1, n < 25 ? 1.0 + n : -1.0 - n};
        joints.push_back(x);
        fixed.push_back(n < 25);
    }
    const JointWeights w = fit_joints(joints, fixed);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        EXPECT_TRUE(std::isfinite(w[0]) && std::isfinite(w[1]));
        EXPECT_EQ(probability(w, joints[j]) > 0.5, fixed[j]) << j;
    }
}

// A room, grouped in three ways. All are judged on the same primitives, and the sampler's energy is
// no higher than that of greedy merges.
TEST(Groupings, AreComparedOnTheSameParts) {
    RoomOptions options;
    options.room.seed = options.camera.seed = 3;
    options.camera.frames = 8;
    options.parse.voxel_m = 0.03;
    options.parse.device = device::open_device("native");
    const RoomParts room = scan_parts(options);
    ASSERT_EQ(room.part.size(), room.points.x.size());
    ASSERT_EQ(room.points.primitive.size(), room.points.x.size());
    JointExamples examples;
    add_examples(room, examples);
    ASSERT_GT(examples.joints.size(), 20u);
    const auto truly = std::ranges::count(examples.fixed, true);
    EXPECT_GT(truly, 3);
    EXPECT_LT(truly, static_cast<std::ptrdiff_t>(examples.fixed.size()) - 3);
    const Groupings found = compare_groupings(*options.parse.device, room, fitted_joint_weights);
    EXPECT_EQ(found.seed, 3u);
    EXPECT_LE(found.sampled_energy, found.greedy_energy + 1e-9);
    EXPECT_GT(found.sampled.fixed_recall.of, 10u);
    for (const scenes::RelationScore* s : {&found.discriminative, &found.greedy})
        EXPECT_EQ(s->fixed_recall.of, found.sampled.fixed_recall.of);
    EXPECT_GT(found.discriminative.fixed_recall.value, 0.2) << "it has learnt something";
    const std::string text = table_of({found, found});
    for (const char* part :
         {"discriminative", "greedy", "SWC", "81.8", "20.5", "60.3", "means of 2"})
        EXPECT_NE(text.find(part), std::string::npos) << part << " in:\n" << text;
}

}  // namespace
}  // namespace topple::evaluation
