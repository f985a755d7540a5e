// SPDX-License-Identifier: MIT
#include "graph/pieces.h"

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

}  // namespace
}  // namespace topple::graph
