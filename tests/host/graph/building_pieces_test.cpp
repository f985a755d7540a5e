// SPDX-License-Identifier: MIT
#include "graph/building_pieces.h"

#include <cmath>

#include "testing.h"

namespace topple::graph {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// A wall, both faces of a cabinet that weak joints hold to it, a panel that a firm one holds, a
// crumb, and a thing of its own.
class BuildingPieces : public testing::Test {
  protected:
    const std::vector<Joint> joints{{0, 1, -2.0}, {0, 2, -1.0}, {0, 3, 4.0},
                                    {1, 2, 0.5},  {1, 3, -1.0}, {2, 5, 3.0}};
    ShellOdds shell{{5.0, -1.0, -2.0, 1.0, 0.0, -4.0}, {true, false, false, false, false, false}};
    Grouping grouping{{-1, -1, -1, -1, -1, 0}, {}};
    const std::vector<std::uint64_t> surface{500, 100, 300, 200, 3, 90};
    KnownLinks known;
    std::vector<std::int32_t> fixed;

    std::vector<BuildingPiece> found() const {
        return building_pieces(joints, known, fixed, shell, grouping, surface);
    }
};

double logistic(double x) {
    return 1 / (1 + std::exp(-x));
}

TEST_F(BuildingPieces, AreAsLikelyThingsAsTheirJointsToTheRestAreUnlikely) {
    const auto pieces = found();
    ASSERT_EQ(pieces.size(), 2u);  // the wall is none, and what hardly was seen
    EXPECT_THAT(pieces[0].primitives, ElementsAre(1, 2));
    EXPECT_NEAR(pieces[0].probability,
                logistic(0.85 - 0.48 * (-2 - 1 - 1) / 3.0 - 0.72 * (100 * -1 + 300 * -2) / 400.0),
                1e-12);
    EXPECT_THAT(pieces[1].primitives, ElementsAre(3));
    EXPECT_NEAR(pieces[1].probability, logistic(0.85 - 0.48 * (4 - 1) / 2.0 - 0.72), 1e-12);
}

TEST_F(BuildingPieces, AreNoneOfWhatIsKnownToBeFixed) {
    fixed = {2};
    ASSERT_EQ(found().size(), 1u);
    EXPECT_THAT(found()[0].primitives, ElementsAre(3));
    known.together = {{0, 3}};
    EXPECT_THAT(found(), IsEmpty());
}

TEST_F(BuildingPieces, AreNoneOfThings) {
    grouping.group = {-1, 1, 1, 0, 0, 0};
    EXPECT_THAT(found(), IsEmpty());
}

}  // namespace
}  // namespace topple::graph
