// SPDX-License-Identifier: MIT
#include "graph/rest.h"

#include "errors.h"
#include "graph/stable_objects.h"
#include "host/graph/floor_scene.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::graph {
namespace {

using test::box;
using test::FloorScene;

class RestOf : public test::EachBackend {
  protected:
    // Of one primitive, an object by itself as each other is; the floor and `walls` are the room's.
    // unseen_below: cells below each that nobody saw into, which contacts don't know of.
    Rest rest(FloorScene& scene, std::int32_t of, std::vector<std::int32_t> walls = {},
              std::uint8_t unseen_below = 0, std::vector<double> floors_m = {}) {
        const ContactGraph contacts = scene.contacts(*device);
        scene.cells.unseen_below.assign(scene.cells.size(), unseen_below);
        std::vector<bool> ground(static_cast<std::size_t>(scene.count));
        std::vector<std::int32_t> object(static_cast<std::size_t>(scene.count));
        ground[0] = true;
        for (const std::int32_t w : walls) ground[w] = true;
        for (std::int32_t p = 0; p < scene.count; ++p) object[p] = ground[p] ? 0 : p;
        const auto columns = undersides(scene.cells, object, object.size());
        return infer_rest(candidate_of(contacts, scene.bodies(*device), ground, {of}), columns[of],
                          contacts, {}, 0, floors_m);
    }
    static std::array<double, 4> bounds(const Rest& rest) {
        std::array<double, 4> out{INFINITY, INFINITY, -INFINITY, -INFINITY};
        for (const auto& [x, y] : rest.support_polygon)
            out = {std::min(out[0], x), std::min(out[1], y), std::max(out[2], x),
                   std::max(out[3], y)};
        return out;
    }
    static auto near(const std::array<double, 4>& b) {
        return testing::Pointwise(testing::DoubleNear(1e-6), b);
    }
};
TOPPLE_ON_EACH_BACKEND(RestOf);

TEST_P(RestOf, ABoxOnTheFloorStandsOnWhatIsSeen) {
    FloorScene scene;
    const auto thing = scene.add(box({0, 0, 0}, {0.2, 0.2, 0.2}));
    const Rest out = rest(scene, thing);
    EXPECT_EQ(out.kind, RestKind::seen);
    EXPECT_THAT(bounds(out), near({0, 0, 0.2, 0.2}));
    EXPECT_NEAR(out.support_height_m, 0, 1e-9);
    // All ways hold it as well: 1 of 1 + 0.3 + 0.1 + 0.03 + 0.009.
    EXPECT_NEAR(out.probability, 1 / 1.439, 1e-3);
}

// Its underside is some centimetres above the floor but at one edge, with a seen gap.
TEST_P(RestOf, NoiseUnderAThingIsBridged) {
    FloorScene scene;
    const auto thing = scene.add([](double x, double y, double z) {
        return x > 0 && x < 0.2 && y > 0 && y < 0.2 && z < 0.3 && z > (x < 0.04 ? 0.0 : 0.06);
    });
    const Rest out = rest(scene, thing);
    EXPECT_EQ(out.kind, RestKind::near);
    EXPECT_THAT(bounds(out), near({0, 0, 0.2, 0.2}));
    EXPECT_NEAR(out.support_height_m, 0, 1e-9);
    EXPECT_GT(out.probability, 0.5);
}

// A board whose foot is 40 cm in front of a wardrobe, which is none of the room's.
TEST_P(RestOf, ABoardLeansOnWhatItTouches) {
    FloorScene scene;
    const auto board = scene.add([](double x, double y, double z) {
        const double at = 0.4 * (1 - z);
        return std::abs(x) < 0.15 && std::abs(y - at) < 0.02 && z > 0 && z < 1;
    });
    scene.add(box({-0.4, -0.3, 0}, {0.4, -0.02, 1.1}));
    const Rest out = rest(scene, board);
    EXPECT_EQ(out.kind, RestKind::leaning);
    EXPECT_LT(bounds(out)[1], 0.06) << "up to where it leans";
    EXPECT_GT(bounds(out)[3], 0.36) << "from its foot";
    EXPECT_GT(out.probability, 0.4);
}

// Where the candidate is held by the room's wall already, that was seen.
TEST_P(RestOf, ABoardOnAWallLeansOnWhatIsSeen) {
    FloorScene scene;
    const auto board = scene.add([](double x, double y, double z) {
        const double at = 0.4 * (1 - z);
        return std::abs(x) < 0.15 && std::abs(y - at) < 0.02 && z > 0 && z < 1;
    });
    const auto wall = scene.add(box({-0.9, -0.06, 0}, {0.9, -0.02, 1.1}));
    EXPECT_EQ(rest(scene, board, {wall}).kind, RestKind::seen);
}

// A box whose centre lies over the edge of what carries it stood there all the same: it does so
// with a margin that is small, but not 0.
TEST_P(RestOf, WhatStandsOverAnEdgeStandsALittleInside) {
    FloorScene scene;
    scene.add(box({0, 0, 0}, {0.2, 0.2, 0.2}));
    const auto thing = scene.add(box({0.1, 0, 0.2}, {0.3, 0.2, 0.4}));
    const Rest out = rest(scene, thing);
    EXPECT_EQ(out.kind, RestKind::seen);
    const double margin = physics::footing(out.support_polygon, 0.2, 0.1).margin_m;
    EXPECT_GT(margin, 0.5 * 0.01) << "of a noise of a centimetre";
    EXPECT_LT(margin, 2 * 0.01);
    EXPECT_GT(out.margin_error_m, 0.3 * 0.01);
    EXPECT_LT(out.margin_error_m, margin);
}

// Carried by its top alone, with its foot two voxels above the floor: it stands.
TEST_P(RestOf, WhatEndsNearTheFloorDoesNotHang) {
    FloorScene scene;
    scene.add(box({0.3, 0, 0}, {0.4, 0.2, 0.4}));
    const auto thing = scene.add([](double x, double y, double z) {
        return x > 0 && x < 0.4 && y > 0 && y < 0.2 && z > (x < 0.3 ? 0.04 : 0.4) && z < 0.5;
    });
    const Rest out = rest(scene, thing);
    EXPECT_EQ(out.kind, RestKind::near);
    EXPECT_NEAR(out.support_height_m, 0, 1e-9);
}

// The floor was not scanned below a bookcase, which a board holds high up, too: it goes on there.
TEST_P(RestOf, TheFloorGoesOnBelowWhatEndsAtIt) {
    FloorScene scene;
    scene.add(box({1.24, 0.14, 0}, {1.4, 0.2, 0.9}));
    const auto thing = scene.add([](double x, double y, double z) {
        return x > 1.02 && x < 1.3 && y > 0 && y < 0.2 && z > (x < 1.24 ? 0.0 : 0.9) && z < 1;
    });
    scene.cells = test::voxelise(scene.solids, {-1, -1, -0.04}, {1.6, 1, 1.2}, 0.02);
    EXPECT_NE(rest(scene, thing).kind, RestKind::near);
    const Rest out = rest(scene, thing, {}, 0, {0.02});
    EXPECT_EQ(out.kind, RestKind::near);
    EXPECT_THAT(bounds(out), near({1.02, 0, 1.24, 0.2}));
    EXPECT_NEAR(out.support_height_m, 0, 1e-6);
    EXPECT_EQ(rest(scene, thing, {}, 0, {0.3}).kind, rest(scene, thing).kind) << "no floor there";
}

// A thing in the air: what the scan shows below it does not hold it.
TEST_P(RestOf, WhatNothingHoldsRestsWhereItIsLowest) {
    FloorScene scene;
    const auto thing = scene.add(box({0, 0, 0.4}, {0.2, 0.2, 0.6}));
    const Rest out = rest(scene, thing);
    EXPECT_EQ(out.kind, RestKind::hidden);
    EXPECT_THAT(bounds(out), near({0, 0, 0.2, 0.2}));
    EXPECT_NEAR(out.support_height_m, 0.4, 1e-6) << "at its foot, not on the floor below";
    EXPECT_NEAR(out.probability, 1 / 1.3, 1e-3) << "its foot, or all of it";
}

// Only a knob of it is lowest, at a corner: all that is above may rest on something.
TEST_P(RestOf, AFootThatIsTooSmallIsNotAllOfIt) {
    FloorScene scene;
    const auto thing = scene.add([](double x, double y, double z) {
        return x > 0 && x < 0.4 && y > 0 && y < 0.4 && z < 0.6 &&
               z > (x < 0.04 && y < 0.04 ? 0.3 : 0.4);
    });
    const Rest out = rest(scene, thing);
    EXPECT_EQ(out.kind, RestKind::hidden);
    EXPECT_THAT(bounds(out), near({0, 0, 0.4, 0.4}));
    EXPECT_GT(out.probability, 0.9);
}

// One side of its foot was seen; below the rest of it nobody saw in.
TEST_P(RestOf, AFootOfWhichOneSideWasSeenGoesOnWhereNobodySaw) {
    FloorScene scene;
    const auto thing = scene.add([](double x, double y, double z) {
        return x > 0 && x < 0.4 && y > 0 && y < 0.2 && z < 0.5 && z > (x < 0.18 ? 0.0 : 0.2);
    });
    EXPECT_EQ(rest(scene, thing).kind, RestKind::seen);
    const Rest out = rest(scene, thing, {}, 10);
    EXPECT_EQ(out.kind, RestKind::near);
    EXPECT_THAT(bounds(out), near({0, 0, 0.4, 0.2}));
    EXPECT_NEAR(out.support_height_m, 0, 1e-9);
}

// What was seen of its foot holds it, but less firmly than if it went on.
TEST_P(RestOf, AFootThatHoldsMayGoOnWhereNobodySaw) {
    FloorScene scene;
    const auto thing = scene.add([](double x, double y, double z) {
        return x > 0 && x < 0.4 && y > 0 && y < 0.6 && z < 0.5 && z > (x < 0.26 ? 0.0 : 0.2);
    });
    EXPECT_EQ(rest(scene, thing).unseen_margin_m, 0);
    const Rest out = rest(scene, thing, {}, 10);
    EXPECT_EQ(out.kind, RestKind::seen);
    EXPECT_NEAR(bounds(out)[2], 0.26, 0.001);
    const double above = 0.4 * 0.3, foot = 0.26 * 0.2;
    EXPECT_NEAR(out.unseen_margin_m, (above * 0.2 + foot * 0.13) / (above + foot), 0.001);
}

// Nobody saw in below it: a box with its foot hidden stands on the floor; of what is hidden for
// more than half of what was seen nobody knows.
TEST_P(RestOf, AFootThatIsHiddenForLongIsNotKnown) {
    for (const bool much : {false, true}) {
        FloorScene scene;
        const double bottom = much ? 0.3 : 0.1;
        const auto thing = scene.add(box({0, 0, bottom}, {0.2, 0.2, 0.5}));
        scene.voxelise();
        scene.cells.unseen_below.assign(scene.cells.size(), 20);
        const Rest out = rest(scene, thing, {}, 20);
        EXPECT_EQ(out.kind, much ? RestKind::hidden : RestKind::seen) << bottom;
        EXPECT_NEAR(out.support_height_m, 0, 1e-9) << "straight down from there";
    }
}

TEST_P(RestOf, WhatHasNoSolidCellsRestsOnNothing) {
    FloorScene scene;
    const auto thing = scene.add(box({0, 0, 0}, {0.001, 0.001, 0.001}));
    const Rest out = rest(scene, thing);
    EXPECT_EQ(out.kind, RestKind::none);
    EXPECT_EQ(out.probability, 1);
    EXPECT_TRUE(out.support_polygon.empty());
}

TEST(Undersides, AreTheLowestCellsOfEachColumn) {
    SolidCells cells;
    cells.voxel_m = 0.1;
    // Column (0, 0): floor, gap of two, a chair's seat and, above air, its back; column (0, 1): its
    // leg on the floor; column (1, 0): over nothing; (1, 1): solid of none, and the seat on it.
    const std::vector<std::array<std::int32_t, 4>> all{{0, 0, 0, 0}, {0, 0, 3, 1},  {0, 0, 4, 1},
                                                       {0, 0, 7, 2}, {0, 1, 0, 0},  {0, 1, 1, 2},
                                                       {1, 0, 5, 1}, {1, 1, 2, -1}, {1, 1, 3, 1}};
    for (const auto& [i, j, k, p] : all) {
        cells.i.push_back(i);
        cells.j.push_back(j);
        cells.k.push_back(k);
        cells.primitive.push_back(p);
    }
    const std::vector<std::int32_t> object{0, 1, 1};
    const auto out = undersides(cells, object, 2);
    const auto is = [](const Underside& u, std::array<std::int32_t, 5> of) {
        return std::array{u.i, u.j, u.k, u.gap, u.primitive} == of;
    };
    ASSERT_EQ(out[0].size(), 2u);
    EXPECT_TRUE(is(out[0][0], {0, 0, 0, -1, -1}));
    EXPECT_TRUE(is(out[0][1], {0, 1, 0, -1, -1}));
    ASSERT_EQ(out[1].size(), 4u);
    EXPECT_TRUE(is(out[1][0], {0, 0, 3, 2, 0}));
    EXPECT_TRUE(is(out[1][1], {0, 1, 1, 0, 0}));
    EXPECT_TRUE(is(out[1][2], {1, 0, 5, -1, -1}));
    EXPECT_TRUE(is(out[1][3], {1, 1, 3, 0, -1}));
}

TEST(RestKinds, HaveNames) {
    EXPECT_STREQ(to_string(RestKind::seen), "seen");
    EXPECT_STREQ(to_string(RestKind::leaning), "leaning");
    EXPECT_STREQ(to_string(RestKind::none), "none");
}

}  // namespace
}  // namespace topple::graph
