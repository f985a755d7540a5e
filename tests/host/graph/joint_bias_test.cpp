// SPDX-License-Identifier: MIT
#include "graph/joint_bias.h"

#include <gtest/gtest.h>

#include <cmath>

namespace topple::graph {
namespace {

// Each of some primitives with each of the others, after one that is pinned and joined to all.
std::vector<Joint> all_pairs(std::int32_t things) {
    std::vector<Joint> out;
    for (std::int32_t a = 0; a <= things; ++a)
        for (std::int32_t b = a + 1; b <= things; ++b) out.push_back({a, b, 0.5 * a + b});
    return out;
}

TEST(JointBias, EachJointHasItAndMoreWhereAllHaveManyNeighbours) {
    for (const std::int32_t things : {0, 1, 2, 6, 8, 11}) {
        std::vector<bool> pinned(static_cast<std::size_t>(things) + 1, false);
        pinned[0] = true;
        const std::vector<Joint> joints = all_pairs(things);
        const std::vector<Joint> out = biased_joints(joints, pinned, -1.5);
        const double crowded = std::max(1.0, (things - 1) / most_neighbours);
        ASSERT_EQ(out.size(), joints.size());
        for (std::size_t n = 0; n < out.size(); ++n) {
            EXPECT_EQ(out[n].a, joints[n].a);
            EXPECT_EQ(out[n].b, joints[n].b);
            EXPECT_NEAR(out[n].log_odds, joints[n].log_odds - 1.5 * std::pow(crowded, 3), 1e-12);
            EXPECT_EQ(biased_joints(joints, pinned, 0)[n].log_odds, joints[n].log_odds);
        }
    }
}

}  // namespace
}  // namespace topple::graph
