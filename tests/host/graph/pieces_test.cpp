// SPDX-License-Identifier: MIT
#include "graph/pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace topple::graph {
namespace {

double chance_of(double log_odds) {
    return 1 / (1 + std::exp(-log_odds));
}

const std::vector<Joint> piece_joints{{0, 1, 3.0}, {0, 2, -2.0}, {1, 2, 1.0},
                                      {1, 3, 0.5}, {2, 3, -1.0}, {3, 4, 2.0}};
const std::vector<std::int32_t> piece_objects{0, 0, 1, 2, 3};
const std::vector<std::uint64_t> piece_surface{50, 40, 30, 0};  // the last one is the ground

TEST(Pieces, AreOfTheLargerThingThatTheLikeliestJointLeadsTo) {
    const std::vector<PieceOf> of = likely_pieces(piece_joints, {}, piece_objects, piece_surface);
    ASSERT_EQ(of.size(), 4u);
    EXPECT_EQ(of[0].primitive, -1) << "others are smaller";
    EXPECT_EQ(of[0].probability, 0);
    EXPECT_EQ(of[1].primitive, 1);
    EXPECT_NEAR(of[1].probability, chance_of(1), 1e-6);
    EXPECT_EQ(of[2].primitive, 1);
    EXPECT_NEAR(of[2].probability, chance_of(0.5), 1e-6);
    EXPECT_EQ(of[3].primitive, -1);
}

TEST(Pieces, WhatIsKnownIsNoQuestion) {
    const KnownLinks links{{}, {{1, 2}}};
    const std::vector<PieceOf> of =
        likely_pieces(piece_joints, links, piece_objects, piece_surface);
    EXPECT_EQ(of[1].primitive, 0);
    EXPECT_NEAR(of[1].probability, chance_of(-2), 1e-6);
}

}  // namespace
}  // namespace topple::graph
