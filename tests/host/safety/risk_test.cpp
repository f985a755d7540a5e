// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "safety/convolution.h"
#include "safety/fields.h"
#include "topple/error.h"

namespace topple::safety {
namespace {

TEST(Risk, SumsReleaseOverTheWorkDistribution) {
    RiskObject cup;
    cup.curve = {{0.1, 2}, {0.5, 5}};
    Disturbance field;
    field.name = "human";
    field.draws = 100;
    field.work = {
        {{0.05, 0.5, {}}, {0.1, 0.2, {}}, {0.4, 0.1, {}}, {0.5, 0.01, {}}, {9, 0.001, {}}}};
    const auto got = risk(field, std::span(&cup, 1));
    ASSERT_EQ(got.size(), 1u);
    const double mean = 0.2 * 2 + 0.1 * 2 + 0.01 * 5 + 0.001 * 5;
    EXPECT_DOUBLE_EQ(got[0].mean_J, mean);
    EXPECT_DOUBLE_EQ(got[0].chance, 0.311);
    EXPECT_DOUBLE_EQ(got[0].spread_J, std::sqrt((0.3 * 4 + 0.011 * 25 - mean * mean) / 100));
    cup.grounded = true;
    EXPECT_EQ(risk(field, std::span(&cup, 1))[0].mean_J, 0);
    EXPECT_THROW(risk(field, {}), Error);
}

TEST(Risk, UnsafetyRunsFromOneToTen) {
    const std::vector<std::vector<Risk>> risks{{{}, {1e-3}, {0.5}}, {{}, {2e-3}, {0.1}}};
    const auto got = unsafety(risks);
    ASSERT_EQ(got.size(), 3u);
    EXPECT_DOUBLE_EQ(got[0], 1);
    EXPECT_GT(got[1], 1);
    EXPECT_LT(got[1], 10);
    EXPECT_DOUBLE_EQ(got[2], 10);
    const std::vector<std::vector<Risk>> none{{{}, {}}};
    EXPECT_EQ(unsafety(none), (std::vector<double>{1, 1}));
    EXPECT_TRUE(unsafety({}).empty());
}

TEST(Risk, OneWalkStrikesOnceAndMostlyHard) {
    Strikes strikes(8);
    strikes[0][3] = 0.5;  // the strongest
    strikes[1][0] = 0.6;
    strikes[1][8] = 0.6;
    std::vector<double> energy{8, 2, 1, 1, 1, 1, 1, 1};
    const auto samples = strongest_strikes(strikes, energy);
    ASSERT_EQ(samples.size(), 3u);
    EXPECT_DOUBLE_EQ(samples[0].W_J, 8);
    EXPECT_DOUBLE_EQ(samples[0].probability, 0.5);
    // Missed by the first, and struck from either side: 0.5 (1 - 0.4 * 0.4), shared evenly.
    EXPECT_NEAR(samples[1].probability, 0.21, 1e-12);
    EXPECT_NEAR(samples[2].probability, 0.21, 1e-12);
    EXPECT_NEAR(samples[1].direction[0], -samples[2].direction[0], 1e-12);
}

TEST(Risk, ManyStrikesStayCompact) {
    Strikes strikes(8);
    for (auto& part : strikes) part.fill(0.01);
    std::vector<double> energy{8, 7, 6, 5, 4, 3, 2, 1};
    const auto samples = strongest_strikes(strikes, energy);
    EXPECT_LE(samples.size(), max_work_samples);
    double sum = 0;
    for (const auto& s : samples) sum += s.probability;
    EXPECT_NEAR(sum, 1 - std::pow(0.99, 128), 1e-12);
}

}  // namespace
}  // namespace topple::safety
