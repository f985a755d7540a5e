// SPDX-License-Identifier: MIT
#include "fitted/boosted_trees.h"

#include "errors.h"
#include "fitted/model_tables.h"

namespace topple::fitted {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::array<std::string_view, 3> columns{"height", "gap", "area"};
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// Two trees over two of the columns, in another order than the columns':
//   area <= 2 ? (gap <= 0.5 ? 1 : -2) : 3    unknown areas to the right, unknown gaps to the left
//   0.25
constexpr std::array<std::string_view, 2> features{"gap", "area"};
constexpr std::array<TreeNode, 6> nodes{{{1, 2, false, 1, 4},
                                         {0, 0.5f, true, 2, 3},
                                         {-1, 1, false, 0, 0},
                                         {-1, -2, false, 0, 0},
                                         {-1, 3, false, 0, 0},
                                         {-1, 0.25f, false, 0, 0}}};
constexpr std::array<std::uint32_t, 2> roots{0, 5};
const TreeTable model{features, nodes, roots, 0.5, 2, -1};

double odds(float gap, float area) {
    const BoostedTrees trees(model, "test.json", columns);
    return trees.log_odds(std::array{99.0f, gap, area});
}

TEST(BoostedTrees, FollowTheSplitsAndScaleTheSum) {
    EXPECT_DOUBLE_EQ(odds(0.2f, 1), 2 * (0.5 + 1 + 0.25) - 1);
    EXPECT_DOUBLE_EQ(odds(0.7f, 1), 2 * (0.5 - 2 + 0.25) - 1);
    EXPECT_DOUBLE_EQ(odds(0.2f, 5), 2 * (0.5 + 3 + 0.25) - 1);
    // What equals the threshold goes left.
    EXPECT_DOUBLE_EQ(odds(0.5f, 2), odds(0.2f, 1));
    EXPECT_DOUBLE_EQ(odds(-INFINITY, -INFINITY), odds(0.2f, 1));
    EXPECT_DOUBLE_EQ(odds(0, INFINITY), odds(0.2f, 5));
}

TEST(BoostedTrees, WhatIsNotKnownGoesWhereTheModelSays) {
    EXPECT_DOUBLE_EQ(odds(nan, 1), odds(0.2f, 1));
    EXPECT_DOUBLE_EQ(odds(0.2f, nan), odds(0.2f, 5));
    EXPECT_DOUBLE_EQ(odds(nan, nan), odds(0.2f, 5));
}

TEST(BoostedTrees, WithoutTreesTheBaselineCounts) {
    TreeTable none = model;
    none.roots = {};
    const BoostedTrees trees(none, "test.json", columns);
    EXPECT_DOUBLE_EQ(trees.log_odds(std::array{1.0f, 1.0f, 1.0f}), 0);
}

TEST(BoostedTrees, AFeatureThatNothingKnowsIsNamed) {
    constexpr std::array<std::string_view, 2> others{"gap", "weight"};
    TreeTable unknown = model;
    unknown.features = others;
    test::expect_input_error([&] { const BoostedTrees trees(unknown, "test.json", columns); },
                             {"test.json", "weight"});
}

TEST(Odds, AndProbabilitiesAreInverse) {
    EXPECT_DOUBLE_EQ(probability(0), 0.5);
    EXPECT_DOUBLE_EQ(probability(std::log(3)), 0.75);
    EXPECT_DOUBLE_EQ(log_odds(0.75), std::log(3));
    for (const double p : {0.001, 0.2, 0.5, 0.9, 0.999})
        EXPECT_NEAR(probability(log_odds(p)), p, 1e-12);
}

TEST(Odds, AreNeverSurerThanAThousandth) {
    EXPECT_EQ(probability(1000), 0.999);
    EXPECT_EQ(probability(-1000), 0.001);
    EXPECT_EQ(probability(INFINITY), 0.999);
    EXPECT_DOUBLE_EQ(log_odds(0), -std::log(999));
    EXPECT_DOUBLE_EQ(log_odds(1), std::log(999));
}

// What is built in, whatever its weights.
TEST(FittedModels, AreSound) {
    for (const TreeTable* table : {&shell_table, &joint_table}) {
        ASSERT_FALSE(table->features.empty());
        EXPECT_FALSE(table->roots.empty());
        EXPECT_GT(table->scale, 0) << "more of the sum is more of the odds";
        const BoostedTrees trees(*table, "test.json", table->features);
        for (const float value : {nan, 0.0f, 1.0f, -1.0f, 1e9f})
            EXPECT_TRUE(
                std::isfinite(trees.log_odds(std::vector<float>(table->features.size(), value))));
    }
}

}  // namespace
}  // namespace topple::fitted
