// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "safety/fields.h"
#include "safety/human/convolution.h"
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

// What is struck takes over all of the energy: it is as heavy, and gives back all.
std::vector<WorkSample> strikes_of(const Strikes& strikes, std::vector<double> energy) {
    SecondaryMotion motion;
    motion.mass_kg.assign(energy.size(), 2);
    motion.energy_J = std::move(energy);
    RiskObject thing;
    thing.mass_kg = 2;
    thing.curve = {{0, 1}};
    return strongest_strikes(strikes, motion, thing, {0, 0.8}, 1);
}

TEST(Risk, OneWalkStrikesOnceAndMostlyHard) {
    Strikes strikes(8);
    strikes[0][3][0] = 0.5;  // the strongest
    strikes[1][0][0] = 0.6;
    strikes[1][8][0] = 0.6;
    const auto samples = strikes_of(strikes, {8, 2, 1, 1, 1, 1, 1, 1});
    ASSERT_EQ(samples.size(), 3u);
    EXPECT_DOUBLE_EQ(samples[0].W_J, 8);
    EXPECT_DOUBLE_EQ(samples[0].probability, 0.5);
    // Missed by the first, and struck from either side: 0.5 (1 - 0.4 * 0.4), shared evenly.
    EXPECT_NEAR(samples[1].probability, 0.21, 1e-12);
    EXPECT_NEAR(samples[2].probability, 0.21, 1e-12);
    EXPECT_NEAR(samples[1].direction[0], -samples[2].direction[0], 1e-12);
    for (const WorkSample& sample : samples) EXPECT_DOUBLE_EQ(sample.height_m, 0.05);
}

// A pass meets a thing in one of the places that it sweeps, as often as each is swept.
TEST(Risk, OnePassStrikesAtOneHeight) {
    Strikes strikes(8);
    for (auto& level : strikes) {
        for (auto& heights : level) {
            heights[2] = 0.01;
            heights[5] = 0.005;
        }
    }
    const auto samples = strikes_of(strikes, {8, 7, 6, 5, 4, 3, 2, 1});
    EXPECT_EQ(samples.size(), 256u);
    double sum = 0, low = 0;
    for (const auto& s : samples) {
        sum += s.probability;
        if (s.height_m < 0.4) low += s.probability;
    }
    EXPECT_NEAR(sum, 1 - std::pow(0.99, 128), 1e-12);
    EXPECT_NEAR(low, 2 * sum / 3, 1e-12);
}

// Of a weak strike that overturns it and a strong one that does not, the weak one counts.
TEST(Risk, OfAWalksStrikesTheOneThatDoesMostCounts) {
    Strikes strikes(2);
    strikes[0][0][0] = strikes[1][0][7] = 0.5;
    const auto samples = strikes_of(strikes, {8, 2});
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_DOUBLE_EQ(samples[0].W_J, 8);
    EXPECT_DOUBLE_EQ(samples[0].probability, 0.5);
    EXPECT_DOUBLE_EQ(samples[1].probability, 0.25);
}

}  // namespace
}  // namespace topple::safety
