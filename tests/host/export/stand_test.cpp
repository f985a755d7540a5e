// SPDX-License-Identifier: MIT
#include "export/stand.h"

#include <algorithm>
#include <cmath>

#include "export/brace.h"
#include "export/floor.h"
#include "export/footing.h"
#include "export/separate.h"
#include "export/simplify.h"
#include "export/touching.h"
#include "host/export/blocks.h"
#include "testing.h"

namespace topple::exports::test {
namespace {

Body ground() {
    return body_of(block({-2, -2, -0.1}, {2, 2, 0}), 0, {});
}

TEST(Separate, WhatStandsGivesWayToWhatCarriesIt) {
    std::vector<Body> bodies{ground(), body_of(block({0, 0, -0.004}, {0.2, 0.2, 0.5}), 1, {0})};
    EXPECT_GT(deepest_overlap_m(bodies), 0.0039);
    separate(bodies);
    EXPECT_LT(deepest_overlap_m(bodies), 1e-6);
    EXPECT_NEAR(bodies[0].parts[0].high[2], 0, 1e-9);
    EXPECT_NEAR(bodies[1].parts[0].low[2], 0, 1e-9);
    EXPECT_NEAR(bodies[1].lost_m3, 0.2 * 0.2 * 0.004, 1e-9);
}

TEST(Separate, AHullThatIsHollowGivesWayToASolid) {
    // A slab with a bump at its far end: its hull rises above it where something stands.
    Body slab = body_of(block({0, 0, -0.1}, {1, 1, 0}), 0, {});
    std::vector<Vec3> points = slab.parts[0].corner;
    points.push_back({1, 0, 0.1});
    points.push_back({1, 1, 0.1});
    ConvexPart hull = *hull_part(points);
    hull.solid = slab.parts[0].solid;
    hull.solid_each_m3 = slab.parts[0].solid_each_m3;
    slab.parts[0] = hull;
    std::vector<Body> bodies{slab, body_of(block({0.2, 0.2, 0}, {0.5, 0.5, 0.4}), 1, {0})};
    separate(bodies);
    EXPECT_LT(deepest_overlap_m(bodies), 1e-6);
    EXPECT_NEAR(bodies[1].parts[0].low[2], 0, 2 * on_plane_m);
}

TEST(Separate, WhatOnlyEdgesTellApartIsLeftAsItIs) {
    // Two square rods, each on an edge, crossing: neither's faces tell them apart.
    std::vector<Vec3> low, high;
    for (const double end : {-1.0, 1.0}) {
        for (const double side : {-0.1, 0.1}) {
            low.push_back({end, side, 0});
            low.push_back({end, 0, side});
            high.push_back({side, end, 0.205});
            high.push_back({0, end, 0.205 + side});
        }
    }
    const ConvexPart a = *hull_part(low), b = *hull_part(high);
    EXPECT_LT(apart(a, b).gap_m, 0);
    EXPECT_FALSE(overlap(a, b));
    std::vector<Body> bodies{body_of(a, 1, {}), body_of(b, 2, {0})};
    separate(bodies);
    EXPECT_EQ(bodies[0].lost_m3, 0);
    EXPECT_EQ(bodies[1].lost_m3, 0);
}

TEST(Settle, ClosesAGapThatNoiseLeft) {
    std::vector<Body> bodies{ground(), body_of(block({0, 0, 0.006}, {0.2, 0.2, 0.5}), 1, {0})};
    settle(bodies, 0.01);
    ASSERT_EQ(bodies.size(), 2u);
    EXPECT_NEAR(bodies[1].parts[0].low[2], 0, 1e-9);
    EXPECT_NEAR(bodies[1].moved_m[2], -0.006, 1e-9);
    EXPECT_NEAR(bodies[1].center_m[2], 0.253 - 0.006, 1e-9);
}

// A block that stands as firmly as it would on the whole of its underside.
Body firm(ConvexPart part, int level, std::vector<std::int32_t> carried_by) {
    Body out = body_of(std::move(part), level, std::move(carried_by));
    out.solid_m3 = out.parts[0].volume_m3;
    out.firm_m = 0.05;
    return out;
}

TEST(Brace, WhatHangsInTheAirGetsAPad) {
    std::vector<Body> bodies{ground(), firm(block({0, 0, 1}, {0.2, 0.2, 1.5}), 1, {})};
    brace(bodies, 0.01);
    ASSERT_EQ(bodies.size(), 3u);
    EXPECT_TRUE(bodies[2].fixed);
    EXPECT_NEAR(bodies[2].parts[0].high[2], 1, 1e-9);
    EXPECT_EQ(bodies[1].carried_by, std::vector<std::int32_t>{2});
}

// By body: free, on a pad, held.
std::string kept(std::vector<Body> bodies) {
    const std::size_t count = bodies.size();
    brace(bodies, 0.01);
    std::string out;
    for (std::size_t n = 0; n < count; ++n) {
        EXPECT_EQ(bodies[n].fixed, bodies[n].level == 0 || bodies[n].held);
        out += bodies[n].held ? 'h' : bodies[n].on_pad ? 'p' : '.';
    }
    return out;
}

// Boxes under a body, whose lowest corners lie at a height.
std::size_t feet_at(const Body& body, double z) {
    return static_cast<std::size_t>(std::ranges::count_if(body.parts, [&](const ConvexPart& part) {
        return std::abs(part.low[2] - z) < 1e-9 && part.high[0] - part.low[0] < 0.011;
    }));
}

TEST(Brace, WhatIsTiltedByNoiseStandsOnFourFeetAlone) {
    std::vector<Vec3> points = block({0, 0, 0}, {0.2, 0.2, 0.5}).corner;
    for (Vec3& p : points)
        if (p[2] == 0 && p[0] > 0.1) p[2] = 0.004;
    std::vector<Body> bodies{ground(), firm(*hull_part(points), 1, {0})};
    brace(bodies, 0.01);
    ASSERT_EQ(bodies.size(), 2u);
    EXPECT_FALSE(bodies[1].on_pad);
    EXPECT_EQ(bodies[1].struts, 0);
    EXPECT_EQ(feet_at(bodies[1], 0), 4u);
    EXPECT_GT(bodies[1].parts[0].low[2], 1e-4);
    EXPECT_GT(margin_m(footing_of(bodies, {true, true}, bodies[1]), bodies[1].center_m), 0.09);
    EXPECT_LT(deepest_overlap_m(bodies), 1e-6);
}

TEST(Brace, FeetOnASlopeHaveLevelStepsOfWhatCarriesThem) {
    std::vector<Vec3> points = block({-1, -1, -0.1}, {1, 1, 0}).corner;
    for (Vec3& p : points)
        if (p[2] == 0) p[2] += 0.05 * p[0];
    std::vector<Body> bodies{body_of(*hull_part(points), 0, {}),
                             firm(block({0, 0, 0.01}, {0.2, 0.2, 0.5}), 1, {0})};
    brace(bodies, 0.01);
    ASSERT_EQ(bodies.size(), 2u);
    EXPECT_EQ(bodies[0].parts.size(), 5u);
    std::size_t level = 0;
    for (const Touch& touch : touches_of(bodies)) level += touch.normal[2] == 1;
    EXPECT_GE(level, 4u);
    EXPECT_LT(deepest_overlap_m(bodies), 1e-6);
}

TEST(Brace, WhatCarriesGoesOnByNoMoreThanAVoxel) {
    // A shelf that ends short of the middle of what stands on it.
    const auto shelf_to = [](double x) {
        return std::vector<Body>{body_of(block({-1, 0, 0.9}, {x, 0.2, 1}), 0, {}),
                                 firm(block({0, 0, 1}, {0.2, 0.2, 1.5}), 1, {0})};
    };
    std::vector<Body> bodies = shelf_to(0.19);
    bodies[1].center_m[0] = 0.195;
    brace(bodies, 0.01);
    EXPECT_EQ(bodies.size(), 2u);
    EXPECT_GT(bodies[0].parts.size(), 1u);
    EXPECT_FALSE(bodies[1].on_pad || bodies[1].held);
    bodies = shelf_to(0.05);
    brace(bodies, 0.01);
    EXPECT_TRUE(bodies[1].on_pad);
}

TEST(Brace, OnlyWhatNothingHoldsGetsAPadOrIsHeld) {
    Body falls = firm(block({0, 0, 1}, {0.2, 0.2, 1.5}), 1, {});
    EXPECT_EQ(kept({ground(), falls}), ".p");
    falls.firm_m = 0;
    EXPECT_EQ(kept({ground(), falls}), "..") << "by itself";
    Body wall = ground();
    wall.parts.push_back(block({-0.1, -1, 0}, {0, 1, 2.5}));
    EXPECT_EQ(kept({wall, firm(block({0, 0, 1.5}, {0.2, 0.2, 2}), 1, {})}), ".h");
    // Two that lean on one another: the upper one stands on the lower one.
    EXPECT_EQ(kept({firm(block({0, 0, 1}, {0.2, 0.2, 1.5}), 2, {1}),
                    firm(block({0, 0, 0.8}, {0.2, 0.2, 1}), 1, {0})}),
              ".p");
}

TEST(Brace, ATableOfWhichOneLegWasSeenGetsStruts) {
    Body table = firm(block({0, 0, 0.7}, {1, 0.6, 0.75}), 1, {0});
    table.parts.push_back(block({0, 0, 0}, {0.05, 0.05, 0.7}));
    table.solid_m3 += table.parts[1].volume_m3;
    std::vector<Body> bodies{ground(), table};
    brace(bodies, 0.02);
    EXPECT_TRUE(bodies[1].on_pad);
    EXPECT_EQ(bodies[1].struts, 0);  // each would be a post of nearly its height
    table.parts[0] = block({0, 0, 0.7}, {1, 0.6, 1.6});
    table.center_m = {0.5, 0.3, 1.1};
    bodies = {ground(), table};
    brace(bodies, 0.02);
    EXPECT_FALSE(bodies[1].held);
    EXPECT_GE(bodies[1].struts, 2);
    const std::vector<bool> stands{true, true};
    EXPECT_GE(margin_m(footing_of(bodies, stands, bodies[1]), bodies[1].center_m), 0.02);
    EXPECT_LT(deepest_overlap_m(bodies), 1e-6);
}

TEST(Brace, WhatCarriesALoadStandsWithItToo) {
    Body bench = firm(block({0, 0, 0.1}, {1, 0.2, 0.5}), 1, {0});
    bench.parts.push_back(block({0.3, 0, 0}, {0.7, 0.2, 0.1}));
    Body load = firm(block({0.9, 0, 0.5}, {1, 0.2, 0.9}), 2, {1});
    std::vector<Body> bodies{ground(), bench};
    brace(bodies, 0.02);
    EXPECT_EQ(bodies[1].struts, 0);
    load.mass_kg = 10 * bench.mass_kg;
    bodies = {ground(), bench, load};
    brace(bodies, 0.02);
    EXPECT_FALSE(bodies[1].held);
    ASSERT_GE(bodies[1].struts, 1);
    EXPECT_EQ(bodies[2].struts, 0);
    EXPECT_GT(margin_m(footing_of(bodies, {true, false, false}, bodies[1]),
                       {(0.5 + 10 * 0.95) / 11, 0.1, 0.6}),
              0.02);
}

TEST(FreePlace, IsTheMiddleOfTheWidestOne) {
    ConvexPart floor = block({0, 0, -0.05}, {4, 2, 0});
    std::vector<Body> bodies{body_of(floor, 0, {}), body_of(block({0, 0, 0}, {1.5, 2, 1}), 1, {0}),
                             body_of(block({3.5, 0, 1.7}, {4, 2, 2}), 1, {})};
    const auto place = free_place(floor, bodies);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->at[0], 2.5, 0.1);
    EXPECT_NEAR(place->at[1], 1, 0.1);
    EXPECT_EQ(place->at[2], 0);
    EXPECT_NEAR(place->radius_m, 1, 0.1);
    // Nobody walks where the floor is only thought to go on.
    std::erase_if(floor.solid, [](const Vec3& p) { return p[0] > 2; });
    bodies.push_back(body_of(block({0, 0, 2}, {4, 2, 2.1}), 1, {}));
    const auto seen = free_place(floor, bodies);
    ASSERT_TRUE(seen);
    EXPECT_LE(seen->at[0], 2.9);
    bodies.push_back(body_of(block({0, 0, 1}, {4, 2, 1.1}), 1, {}));
    EXPECT_FALSE(free_place(floor, bodies));
}

TEST(Footing, OfCrossedBarsIsWhereTheyCross) {
    std::vector<Body> bodies{body_of(block({-1, -0.1, 0}, {1, 0.1, 0.2}), 0, {}),
                             body_of(block({-0.1, -1, 0.2}, {0.1, 1, 0.4}), 1, {0})};
    const std::vector<bool> stands{true, false};
    EXPECT_NEAR(margin_m(footing_of(bodies, stands, bodies[1]), bodies[1].center_m), 0.1, 1e-9);
    EXPECT_TRUE(footing_of(bodies, {false, false}, bodies[1]).empty());
}

TEST(WidenFloor, ReachesUnderWhatBeginsAtItsHeight) {
    ConvexPart floor = block({0, 0, -0.05}, {1, 1, 0});
    const std::vector<Body> bodies{body_of(block({2, 0, 0.02}, {3, 1, 1}), 1, {}),
                                   body_of(block({5, 0, 1}, {6, 1, 2}), 1, {})};
    widen_floor(floor, bodies, 0.02);
    EXPECT_NEAR(floor.high[0], 3, 1e-9);
    EXPECT_NEAR(floor.high[2], 0, 1e-9);
    EXPECT_NEAR(floor.volume_m3, 3 * 0.05, 1e-9);
}

TEST(Separate, WhatLiesWithinAnotherOnesHullIsCarvedOutOfIt) {
    // A bench's hull, which holds what stands under its seat.
    Body bench = body_of(block({0, 0, 0}, {2, 1, 1}), 1, {});
    std::erase_if(bench.parts[0].solid,
                  [](const Vec3& p) { return p[2] < 0.9 && p[0] > 0.3 && p[0] < 1.7; });
    std::vector<Body> bodies{bench, body_of(block({0.8, 0.3, 0}, {1.2, 0.7, 0.5}), 1, {})};
    for (Body& body : bodies) body.solid_m3 = body.parts[0].volume_m3;
    separate(bodies);
    EXPECT_LT(deepest_overlap_m(bodies), 1e-6);
    EXPECT_NEAR(bodies[1].parts[0].volume_m3, 0.4 * 0.4 * 0.5, 1e-4);
    EXPECT_GE(bodies[0].parts.size(), 2u);
}

TEST(Separate, SolidThatASimplerHullLeftOutsideEndsNothing) {
    // Beyond the block's end, where nothing of the bench's hull is left, most of its points lie.
    Body bench = body_of(block({0, 0, 0}, {2, 1, 1}), 1, {});
    std::erase_if(bench.parts[0].solid, [](const Vec3& p) { return p[2] < 0.9 && p[0] > 0.3; });
    for (int n = 0; n < 200; ++n) bench.parts[0].solid.push_back({2 + 2 * on_plane_m, 0.5, 0.2});
    std::vector<Body> bodies{bench, body_of(block({1.6, 0.3, 0}, {2, 0.7, 0.5}), 1, {})};
    for (Body& body : bodies) body.solid_m3 = body.parts[0].volume_m3;
    separate(bodies);
    EXPECT_LT(deepest_overlap_m(bodies), 1e-6);
}

TEST(ClearSides, WhatStandsBesideSomethingTouchesOnlyWhatItStandsOn) {
    std::vector<Body> bodies{ground(), body_of(block({0, 0, 0}, {0.5, 0.5, 0.5}), 1, {0}),
                             body_of(block({0.5, 0, 0}, {1, 0.5, 0.5}), 1, {0})};
    clear_sides(bodies);
    const double gap = apart(bodies[1].parts[0], bodies[2].parts[0]).gap_m;
    EXPECT_GT(gap, 1e-4);
    EXPECT_LT(gap, 5e-4);
    EXPECT_EQ(bodies[1].parts[0].low[2], 0);
    EXPECT_EQ(bodies[2].parts[0].low[2], 0);
}

TEST(Simplified, ABallKeepsItsFormWithAsManyCornersAsEnginesTake) {
    std::vector<Vec3> points;
    for (int n = 0; n < 2000; ++n) {
        const double z = -1 + (n + 0.5) / 1000, a = 2.399963 * n, r = std::sqrt(1 - z * z);
        points.push_back({0.1 * r * std::cos(a), 0.1 * r * std::sin(a), 0.1 * z});
    }
    const ConvexPart ball = *hull_part(points), fine = simplified(ball, 0.001),
                     coarse = simplified(ball, 1e-6);
    EXPECT_LE(coarse.corner.size(), most_corners);
    EXPECT_GT(coarse.volume_m3, 0.85 * ball.volume_m3);
    EXPECT_LE(fine.corner.size(), most_corners);
    for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_EQ(coarse.low[a], ball.low[a]);
        EXPECT_EQ(coarse.high[a], ball.high[a]);
    }
}

TEST(Simplified, NothingMoreThanTheToleranceIsLost) {
    // A box with bevelled edges, some of them finer than the tolerance.
    std::vector<Vec3> points;
    for (const double bevel : {0.0004, 0.02})
        for (unsigned c = 0; c < 24; ++c) {
            Vec3 p{(c & 1) != 0 ? 0.1 : -0.1, (c & 2) != 0 ? 0.1 : -0.1, (c & 4) != 0 ? 0.1 : -0.1};
            if (bevel > 0.01 && p[0] > 0) continue;
            if (bevel < 0.01 && p[0] < 0) continue;
            p[c / 8] *= 1 - bevel / 0.1;
            points.push_back(p);
        }
    const ConvexPart part = *hull_part(points), left = simplified(part, 0.001);
    EXPECT_LT(left.corner.size(), part.corner.size());
    for (const HalfSpace& side : left.face)
        EXPECT_LE(extent_along(part, side.normal).high, side.offset_m + 0.001);
}

}  // namespace
}  // namespace topple::exports::test
