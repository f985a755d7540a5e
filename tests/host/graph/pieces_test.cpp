// SPDX-License-Identifier: MIT
#include "graph/pieces.h"

#include <cmath>

#include "testing.h"

namespace topple::graph {
namespace {

using testing::ElementsAre;

Joint joint(std::int32_t a, std::int32_t b, double log_odds) {
    Joint out;
    out.a = a;
    out.b = b;
    out.log_odds = log_odds;
    return out;
}

// Of two pairs, {2, 4} and {5, 7}, that hang together by a weak joint and a weaker one.
TEST(BothSides, AreWhatIsLeftWithoutTheJoint) {
    const std::vector<Joint> joints{joint(2, 4, 3), joint(2, 7, -0.5), joint(4, 5, 0.2),
                                    joint(5, 7, 2), joint(7, 9, 5)};
    const std::vector<std::int32_t> primitives{2, 4, 5, 7};
    EXPECT_THAT(both_sides(joints, {}, primitives, {0.55, 4, 5}),
                ElementsAre(ElementsAre(2, 4), ElementsAre(5, 7)));
}

TEST(BothSides, KeepTogetherWhatIsKnownToBe) {
    const std::vector<Joint> joints{joint(0, 1, 1), joint(1, 2, 0.3)};
    KnownLinks known;
    known.together = {{0, 3}};
    const std::vector<std::int32_t> primitives{0, 1, 2, 3};
    EXPECT_THAT(both_sides(joints, known, primitives, {0.6, 1, 2}),
                ElementsAre(ElementsAre(0, 1, 3), ElementsAre(2)));
}

TEST(BothSides, WhatNoJointReachesIsWithTheFirst) {
    const std::vector<Joint> joints{joint(0, 2, 0.1)};
    const std::vector<std::int32_t> primitives{0, 1, 2};
    EXPECT_THAT(both_sides(joints, {}, primitives, {0.5, 0, 2}),
                ElementsAre(ElementsAre(0, 1), ElementsAre(2)));
}

double chance_of(double log_odds) {
    return 1 / (1 + std::exp(-log_odds));
}

// Of two objects with joints of that mean.
double chance_between(double mean_log_odds) {
    return chance_of(1.11 * mean_log_odds - 0.41);
}

const std::vector<Joint> piece_joints{{0, 1, 3.0}, {0, 2, -2.0}, {1, 2, 1.0},
                                      {1, 3, 0.5}, {2, 3, -1.0}, {3, 4, 2.0}};
const std::vector<std::int32_t> piece_objects{0, 0, 1, 2, 3};
const std::vector<std::uint64_t> piece_surface{50, 40, 30, 0};  // the last one is the ground

TEST(Pieces, AreOfTheLargerThingThatAllJointsToItSaySo) {
    const std::vector<PieceOf> of = likely_pieces(piece_joints, {}, piece_objects, piece_surface);
    ASSERT_EQ(of.size(), 4u);
    EXPECT_EQ(of[0].primitive, -1) << "others are smaller";
    EXPECT_EQ(of[0].probability, 0);
    EXPECT_EQ(of[1].primitive, 1);
    EXPECT_NEAR(of[1].probability, chance_between(-0.5), 1e-6);
    EXPECT_EQ(of[2].primitive, 1);
    EXPECT_NEAR(of[2].probability, chance_between(0.5), 1e-6);
    EXPECT_EQ(of[3].primitive, -1);
}

TEST(Pieces, ObjectsSaidToBeApartAreNoQuestionByAnyJoint) {
    // Of 1 and 3, which are objects 0 and 2, a joint; said of 0 and 3.
    const KnownLinks links{{}, {{0, 3}}};
    const std::vector<PieceOf> of =
        likely_pieces(piece_joints, links, piece_objects, piece_surface);
    EXPECT_EQ(of[2].primitive, 2);
    EXPECT_NEAR(of[2].probability, chance_between(-1), 1e-6);
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

TEST(Pieces, AreTheLessLikelyWholeThings) {
    for (const std::uint64_t voxels : {20u, 300u, 5000u}) {
        double last = 1;
        for (const double piece : {0.05, 0.2, 0.4, 0.9}) {
            const double whole = whole_probability({piece, 0}, {}, voxels);
            EXPECT_LT(whole, last) << piece << " of " << voxels;
            last = whole;
        }
        EXPECT_GT(whole_probability({0.05, 0}, {}, voxels), 0.7);
        EXPECT_LT(last, 0.3);
    }
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
