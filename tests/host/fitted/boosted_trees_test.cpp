// SPDX-License-Identifier: MIT
#include "fitted/boosted_trees.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "fitted/model_files.h"
#include "topple/error.h"

namespace topple::fitted {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::array<std::string_view, 3> columns{"height", "gap", "area"};
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// Two trees over two of the columns, in another order than the columns':
//   area <= 2 ? (gap <= 0.5 ? 1 : -2) : 3    unknown areas to the right, unknown gaps to the left
//   0.25
nlohmann::json model() {
    return nlohmann::json::parse(R"({
        "schema": "topple.trees/1", "about": "a test", "features": ["gap", "area"],
        "baseline": 0.5, "scale": 2, "offset": -1,
        "trees": [{"feature": [1, 0, -1, -1, -1], "threshold": [2, 0.5, 1, -2, 3],
                   "missing_left": [0, 1, 0, 0, 0], "left": [1, 2, 0, 0, 0],
                   "right": [4, 3, 0, 0, 0]},
                  {"feature": [-1], "threshold": [0.25], "missing_left": [0], "left": [0],
                   "right": [0]}]})");
}

double odds(float gap, float area) {
    const BoostedTrees trees(model().dump(), "test.json", columns);
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
    nlohmann::json none = model();
    none["trees"] = nlohmann::json::array();
    const BoostedTrees trees(none.dump(), "test.json", columns);
    EXPECT_DOUBLE_EQ(trees.log_odds(std::array{1.0f, 1.0f, 1.0f}), 0);
}

// What one damage to the file above is answered with.
std::string refused(const std::string& text) {
    try {
        const BoostedTrees trees(text, "test.json", columns);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    ADD_FAILURE() << "was taken: " << text;
    return "";
}

TEST(BoostedTrees, ADamagedFileIsRefusedByName) {
    EXPECT_THAT(refused("{"), HasSubstr("test.json"));
    EXPECT_THAT(refused(""), HasSubstr("test.json"));
    EXPECT_THAT(refused("[]"), HasSubstr("test.json"));
    nlohmann::json other = model();
    other["schema"] = "topple.trees/2";
    EXPECT_THAT(refused(other.dump()), AllOf(HasSubstr("test.json"), HasSubstr("topple.trees/1")));
    for (const char* field : {"schema", "features", "baseline", "scale", "offset", "trees"}) {
        nlohmann::json less = model();
        less.erase(field);
        EXPECT_THAT(refused(less.dump()), AllOf(HasSubstr("test.json"), HasSubstr(field)));
    }
    nlohmann::json words = model();
    words["baseline"] = "much";
    EXPECT_THAT(refused(words.dump()), HasSubstr("test.json"));
    nlohmann::json numbers = model();
    numbers["features"] = {1, 2};
    EXPECT_THAT(refused(numbers.dump()), HasSubstr("test.json"));
}

TEST(BoostedTrees, AFeatureThatNothingKnowsIsNamed) {
    nlohmann::json unknown = model();
    unknown["features"] = {"gap", "weight"};
    EXPECT_THAT(refused(unknown.dump()), AllOf(HasSubstr("test.json"), HasSubstr("weight")));
}

TEST(BoostedTrees, ADamagedTreeIsRefusedByNumber) {
    for (const char* array : {"feature", "threshold", "missing_left", "left", "right"}) {
        nlohmann::json shorter = model();
        shorter["trees"][0][array].erase(4);
        EXPECT_THAT(refused(shorter.dump()), AllOf(HasSubstr("test.json"), HasSubstr("tree 0")))
            << array;
        nlohmann::json none = model();
        none["trees"][1].erase(array);
        EXPECT_THAT(refused(none.dump()), AllOf(HasSubstr("test.json"), HasSubstr(array)));
    }
    const auto broken = [](const char* array, std::size_t at, std::int64_t value) {
        nlohmann::json file = model();
        file["trees"][0][array][at] = value;
        EXPECT_THAT(refused(file.dump()), HasSubstr("tree 0")) << array << at << "=" << value;
    };
    broken("feature", 0, 2);  // of two
    broken("left", 0, 0);     // itself
    broken("left", 1, 0);     // back up: without an end
    broken("right", 0, 5);    // of five
    broken("left", 1, -1);
    broken("right", 1, 1 << 30);
    nlohmann::json empty = model();
    for (const char* array : {"feature", "threshold", "missing_left", "left", "right"})
        empty["trees"][1][array] = nlohmann::json::array();
    EXPECT_THAT(refused(empty.dump()), HasSubstr("tree 1"));
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

// The files that are built in load with the features that they name, whatever their weights.
TEST(FittedModels, AreSound) {
    for (const std::string_view text : {shell_model_json(), joint_model_json()}) {
        const auto file = nlohmann::json::parse(text);
        const auto names = file.at("features").get<std::vector<std::string>>();
        ASSERT_FALSE(names.empty());
        const std::vector<std::string_view> all(names.begin(), names.end());
        const BoostedTrees trees(text, file.at("about"), all);
        for (const float value : {nan, 0.0f, 1.0f, -1.0f, 1e9f})
            EXPECT_TRUE(std::isfinite(trees.log_odds(std::vector<float>(names.size(), value))));
        EXPECT_GT(file.at("scale").get<double>(), 0) << "more of the sum is more of the odds";
        EXPECT_FALSE(file.at("trees").empty());
    }
}

}  // namespace
}  // namespace topple::fitted
