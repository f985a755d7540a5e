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

TEST(Pieces, ObjectsSaidToBeApartAreNoQuestionByAnyJoint) {
    // Of 1 and 3, which are objects 0 and 2, a joint; said of 0 and 3.
    const KnownLinks links{{}, {{0, 3}}};
    const std::vector<PieceOf> of =
        likely_pieces(piece_joints, links, piece_objects, piece_surface);
    EXPECT_EQ(of[2].primitive, 2);
    EXPECT_NEAR(of[2].probability, chance_of(-1), 1e-6);
}

TEST(Pieces, HangTogetherByTheLeastLikelyJointOfTwoLargerParts) {
    // A ring of four parts and a speck: its best way round counts, and the speck does not.
    const std::vector<Joint> joints{
        {0, 1, 3.0}, {0, 3, -1.0}, {1, 2, 0.2}, {2, 3, 2.0}, {3, 4, -4.0}};
    const std::vector<std::int32_t> one{0, 0, 0, 0, 0};
    const std::vector<std::uint64_t> surface{100, 90, 80, 70, 5};
    const std::vector<WeakestJoint> found = weakest_joints(joints, {}, one, surface, 1);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].a, 1);
    EXPECT_EQ(found[0].b, 2);
    EXPECT_NEAR(found[0].probability, chance_of(0.2), 1e-6);
    EXPECT_TRUE(found[0].doubtful());
    // What is known to be one is one part.
    const WeakestJoint known = weakest_joints(joints, {{{1, 2}}, {}}, one, surface, 1)[0];
    EXPECT_NEAR(known.probability, chance_of(2), 1e-6);
    // Joints to others don't count, and one part has none.
    const std::vector<std::int32_t> split{0, 0, 1, 1, 2};
    const std::vector<WeakestJoint> parted = weakest_joints(joints, {}, split, surface, 3);
    EXPECT_NEAR(parted[0].probability, chance_of(3), 1e-6);
    EXPECT_NEAR(parted[1].probability, chance_of(2), 1e-6);
    EXPECT_EQ(parted[2].probability, 1);
    EXPECT_EQ(parted[2].a, -1);
}

TEST(Pieces, WhatIsKnownIsNoQuestion) {
    const KnownLinks links{{}, {{1, 2}}};
    const std::vector<PieceOf> of =
        likely_pieces(piece_joints, links, piece_objects, piece_surface);
    EXPECT_EQ(of[1].primitive, -1) << "the two objects are known to be apart";
    EXPECT_EQ(of[1].probability, 0);
}

}  // namespace
}  // namespace topple::graph
