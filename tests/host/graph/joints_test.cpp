// SPDX-License-Identifier: MIT
#include "graph/joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace topple::graph {
namespace {

TEST(Joints, EachHasTheBias) {
    const std::vector<Joint> joints{{0, 1, 2.5}, {0, 2, -1}, {3, 4, 0}};
    const std::vector<Joint> out = biased_joints(joints, -1.5);
    ASSERT_EQ(out.size(), joints.size());
    for (std::size_t n = 0; n < out.size(); ++n) {
        EXPECT_EQ(out[n].a, joints[n].a);
        EXPECT_EQ(out[n].b, joints[n].b);
        EXPECT_EQ(out[n].log_odds, joints[n].log_odds - 1.5);
    }
}

TEST(Joints, AreDoubtedWhereNoiseBreaksSurfacesIntoFragments) {
    const auto doubt = [](std::size_t count, std::size_t samples) {
        return doubt_of_fragments(std::vector(count, samples));
    };
    EXPECT_EQ(doubt(0, 0), 0);
    EXPECT_EQ(doubt(500, 30), 0);
    EXPECT_EQ(doubt(500, 2000), 0);
    EXPECT_NEAR(doubt(990, 6), 1.15 * 0.99 * (3.4 - std::log(6)), 1e-9);
    EXPECT_NEAR(doubt(990, 0), 1.15 * 0.99 * 3.4, 1e-9);
    EXPECT_NEAR(doubt(10, 6), 1.15 * 0.5 * (3.4 - std::log(6)), 1e-9);  // a few small things
    EXPECT_GT(doubt(500, 5), doubt(500, 6));
}

}  // namespace
}  // namespace topple::graph
