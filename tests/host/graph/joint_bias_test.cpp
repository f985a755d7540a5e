// SPDX-License-Identifier: MIT
#include "graph/joint_bias.h"

#include <gtest/gtest.h>

namespace topple::graph {
namespace {

// 0 to 3 in a ring of likely joints with a chord, 4 at 0 alone, 5 beside 1 but unlikely.
const std::vector<Joint> joints{{0, 1, 1}, {0, 2, 2},  {0, 3, 0.5},  {0, 4, 0.25},
                                {1, 2, 3}, {1, 5, -2}, {2, 3, 0.125}};

TEST(JointBias, WhatIsAloneIsBelieved) {
    const auto out = biased_joints(joints, 6, -1.5);
    ASSERT_EQ(out.size(), joints.size());
    EXPECT_DOUBLE_EQ(out[3].log_odds, 0.25) << "4 has no other likely joint";
    EXPECT_DOUBLE_EQ(out[5].log_odds, -2) << "5 has none at all";
}

TEST(JointBias, GrowsWithTheWitnessesOfTheEndThatHasFewer) {
    const auto out = biased_joints(joints, 6, -1.5);
    EXPECT_DOUBLE_EQ(out[0].log_odds, 1 - 1.5 / 2) << "0 has four, 1 has two";
    EXPECT_DOUBLE_EQ(out[1].log_odds, 2 - 1.5 * 2 / 3) << "0 has four, 2 has three";
    EXPECT_DOUBLE_EQ(out[6].log_odds, 0.125 - 1.5 / 2) << "3 has two";
    for (std::size_t n = 0; n < out.size(); ++n) {
        EXPECT_EQ(out[n].a, joints[n].a);
        EXPECT_EQ(out[n].b, joints[n].b);
    }
}

TEST(JointBias, NothingMakesNothing) {
    EXPECT_TRUE(biased_joints({}, 3, -1.5).empty());
    for (std::size_t n = 0; n < joints.size(); ++n)
        EXPECT_EQ(biased_joints(joints, 6, 0)[n].log_odds, joints[n].log_odds);
}

}  // namespace
}  // namespace topple::graph
