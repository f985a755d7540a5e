// SPDX-License-Identifier: MIT
#include "lab/evaluation/groupings.h"

#include "core/random.h"
#include "device/devices.h"
#include "lab/evaluation/greedy.h"
#include "lab/scores/relation_score.h"
#include "testing.h"
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

// What every sensible model says of generated rooms, with wide limits.

// How often what is true has a higher value than what is not: the area under the curve.
double area_under_curve(const std::vector<double>& of_true, const std::vector<double>& of_false) {
    double right = 0;
    for (const double t : of_true)
        for (const double f : of_false) right += t > f ? 1 : t == f ? 0.5 : 0;
    return right / static_cast<double>(of_true.size() * of_false.size());
}

double share_above(const std::vector<double>& values, double limit) {
    return static_cast<double>(std::ranges::count_if(values, [&](double v) { return v > limit; })) /
           static_cast<double>(values.size());
}

// The true body of each primitive with at least 50 points, four fifths of which are that body's.
std::vector<std::int32_t> sure_bodies(const RoomParts& room) {
    const std::vector<std::int32_t> body = scenes::true_bodies(room.world);
    std::vector<std::map<std::int32_t, std::size_t>> votes(room.parts.bodies.size());
    std::vector<std::size_t> points(room.parts.bodies.size());
    for (std::size_t n = 0; n < room.part.size(); ++n) {
        if (room.points.primitive[n] < 0) continue;
        const auto p = static_cast<std::size_t>(room.points.primitive[n]);
        ++points[p];
        if (room.part[n] >= 0) ++votes[p][body[room.part[n]]];
    }
    std::vector<std::int32_t> out(votes.size(), -1);
    for (std::size_t p = 0; p < votes.size(); ++p) {
        for (const auto& [b, count] : votes[p])
            if (points[p] >= 50 && 5 * count >= 4 * points[p]) out[p] = b;
    }
    return out;
}

// Chairs' legs and their seats, boxes on tables, walls and wardrobes: plain rooms and varied ones.
TEST(Groupings, TheModelsTellJointsAndTheRoom) {
    std::vector<double> room_odds, thing_odds, one_odds, two_odds;
    for (const bool varied : {false, true}) {
        RoomOptions options;
        options.room.seed = options.camera.seed = 5;
        options.room.varied = varied;
        options.camera.frames = 20;
        options.parse.voxel_m = 0.02;
        options.parse.device = device::open_device("native");
        const RoomParts room = scan_parts(options);
        const std::vector<std::int32_t> body = sure_bodies(room);
        const std::int32_t building = scenes::true_bodies(room.world).front();
        for (std::size_t p = 0; p < body.size(); ++p) {
            if (body[p] >= 0)
                (body[p] == building ? room_odds : thing_odds)
                    .push_back(room.parts.shell.log_odds[p]);
        }
        for (const graph::Joint& joint : room.parts.joints) {
            const std::int32_t a = body[joint.a], b = body[joint.b];
            if (a < 0 || b < 0 || (a == building && b == building)) continue;
            (a == b ? one_odds : two_odds).push_back(joint.log_odds);
        }
    }
    ASSERT_GT(room_odds.size(), 8u);
    ASSERT_GT(thing_odds.size(), 30u);
    ASSERT_GT(one_odds.size(), 20u);
    ASSERT_GT(two_odds.size(), 20u);
    EXPECT_GT(area_under_curve(room_odds, thing_odds), 0.9);
    EXPECT_GT(share_above(room_odds, 0), 0.7);
    EXPECT_LT(share_above(thing_odds, 0), 0.15);
    EXPECT_GT(area_under_curve(one_odds, two_odds), 0.8);
    EXPECT_GT(share_above(one_odds, 0), 0.5);
    EXPECT_LT(share_above(two_odds, 0), 0.3);
    std::printf(
        "shell: AUC %.3f, found %.2f, false %.2f; joints: AUC %.3f, found %.2f, false %.2f\n",
        area_under_curve(room_odds, thing_odds), share_above(room_odds, 0),
        share_above(thing_odds, 0), area_under_curve(one_odds, two_odds), share_above(one_odds, 0),
        share_above(two_odds, 0));
}

}  // namespace
}  // namespace topple::evaluation
