// SPDX-License-Identifier: MIT
#include "graph/stable_objects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "graph/joinery.h"
#include "host/physics/solids.h"
#include "kernels/device_harness.h"

namespace topple::graph {
namespace {

using test::box;
using test::Inside;
using test::Solid;

Inside cylinder(double x0, double y0, double r, double low, double high) {
    return [=](double x, double y, double z) {
        return std::hypot(x - x0, y - y0) < r && z > low && z < high;
    };
}

// A room's floor is primitive 0; the others follow. All joints are concave but those in `flush`.
struct Scene {
    std::vector<Solid> solids{{0, box({-1, -1, -0.04}, {1, 1, 0})}};
    SurfaceSeams seams;
    SolidCells cells;
    std::int32_t count = 1;
    std::vector<std::int32_t> shell{0};

    std::int32_t add(const Inside& inside) {
        solids.push_back({count, inside});
        return count++;
    }
    void flush(std::int32_t a, std::int32_t b) { seams.between[{a, b}] = {0, 100, 100}; }
    void ledge(std::int32_t a, std::int32_t b) { seams.between[{a, b}] = {0, 100, 0, 100}; }
    void voxelise() { cells = test::voxelise(solids, {-1, -1, -0.04}, {1, 1, 1.2}, 0.02); }
};

class Objects : public test::EachBackend {
  protected:
    ContactGraph contacts(Scene& scene) {
        if (scene.cells.size() == 0) scene.voxelise();
        return build_contact_graph(*device, scene.cells, scene.count);
    }
    std::vector<std::int32_t> groups(Scene& scene, std::uint64_t seed = 1) {
        const ContactGraph graph = contacts(scene);
        const std::vector<double> density(static_cast<std::size_t>(scene.count), 700);
        const auto bodies = physics::mass_properties(*device, scene.cells, scene.count, density);
        const physics::SupportTable table(*device, scene.cells, scene.count,
                                          physics::geodesic_sphere(8));
        scene.seams.inside.resize(static_cast<std::size_t>(scene.count));
        std::vector<bool> ground(static_cast<std::size_t>(scene.count), false);
        for (const std::int32_t p : scene.shell) ground[static_cast<std::size_t>(p)] = true;
        GroupingOptions options;
        options.seed = seed;
        return group_primitives(*device, table, scene.cells, graph, bodies, scene.seams, ground,
                                options)
            .group;
    }
};
TOPPLE_ON_EACH_BACKEND(Objects);

TEST_P(Objects, LegsGoWithTheTableAndTheCupStaysFree) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        Scene scene;
        const auto top = scene.add(box({-0.4, -0.3, 0.6}, {0.4, 0.3, 0.64}));
        std::vector<std::int32_t> legs;
        for (const double x : {-0.4, 0.36})
            for (const double y : {-0.3, 0.26})
                legs.push_back(scene.add(box({x, y, 0}, {x + 0.04, y + 0.04, 0.6})));
        const auto cup = scene.add(cylinder(0.1, 0, 0.04, 0.64, 0.74));
        const std::vector<std::int32_t> group = groups(scene, seed);
        for (const std::int32_t leg : legs)
            EXPECT_EQ(group[static_cast<std::size_t>(leg)], group[static_cast<std::size_t>(top)]);
        EXPECT_NE(group[static_cast<std::size_t>(cup)], group[static_cast<std::size_t>(top)]);
        EXPECT_NE(group[static_cast<std::size_t>(top)], -1) << "glued to the floor";
    }
}

// The shade could not roll off the pole on a plane at the pole's height: it falls past it.
TEST_P(Objects, ALampIsOneThing) {
    Scene scene;
    const auto base = scene.add(cylinder(0, 0, 0.12, 0, 0.02));
    const auto pole = scene.add(cylinder(0, 0, 0.02, 0.02, 0.5));
    const auto shade = scene.add(cylinder(0, 0, 0.12, 0.5, 0.7));
    const std::vector<std::int32_t> group = groups(scene);
    EXPECT_EQ(group[static_cast<std::size_t>(base)], group[static_cast<std::size_t>(pole)]);
    EXPECT_EQ(group[static_cast<std::size_t>(shade)], group[static_cast<std::size_t>(pole)]);
    EXPECT_NE(group[static_cast<std::size_t>(base)], -1);
}

// Its pole came in pieces of a few voxels each.
TEST_P(Objects, ALampWithAPoleOfScrapsIsOneThing) {
    Scene scene;
    const auto base = scene.add(cylinder(0, 0, 0.08, 0, 0.04));
    std::vector<std::int32_t> pole;
    for (const double z : {0.04, 0.2})
        pole.push_back(scene.add(box({-0.02, -0.02, z}, {0.02, 0.02, z + 0.16})));
    const auto shade = scene.add(cylinder(0, 0, 0.08, 0.36, 0.48));
    const auto beside = scene.add(box({0.3, -0.1, 0}, {0.5, 0.1, 0.2}));
    const std::vector<std::int32_t> group = groups(scene);
    for (const std::int32_t part : {pole[0], pole[1], shade})
        EXPECT_EQ(group[static_cast<std::size_t>(part)], group[static_cast<std::size_t>(base)]);
    EXPECT_NE(group[static_cast<std::size_t>(base)], -1) << "glued to the floor";
    EXPECT_NE(group[static_cast<std::size_t>(base)], group[static_cast<std::size_t>(beside)]);
}

TEST_P(Objects, BooksOfAlmostOneSizeAreTwoWhereALedgeWasSeen) {
    Scene scene;
    const auto lower = scene.add(box({0, 0, 0}, {0.26, 0.2, 0.08}));
    const auto upper = scene.add(box({0.02, 0, 0.08}, {0.26, 0.2, 0.16}));
    scene.ledge(lower, upper);
    const std::vector<std::int32_t> group = groups(scene);
    EXPECT_NE(group[static_cast<std::size_t>(lower)], group[static_cast<std::size_t>(upper)]);
    EXPECT_NE(group[static_cast<std::size_t>(lower)], -1);
}

TEST_P(Objects, FlushPartsAreOneAndStackedBoxesAreTwo) {
    for (const bool flush : {false, true}) {
        Scene scene;
        const auto lower = scene.add(box({0, 0, 0}, {0.3, 0.3, 0.2}));
        const auto upper = scene.add(box({0, 0, 0.2}, {0.3, 0.1, 0.4}));
        if (flush) scene.flush(lower, upper);
        const std::vector<std::int32_t> group = groups(scene);
        EXPECT_EQ(group[static_cast<std::size_t>(lower)] == group[static_cast<std::size_t>(upper)],
                  flush);
    }
}

// A box too slender to stand well is not held by the corner of a flat one beside it.
TEST_P(Objects, NeighboursThatBarelyTouchStayApart) {
    Scene scene;
    const auto a = scene.add(box({0, 0, 0}, {0.2, 0.06, 0.3}));
    const auto b = scene.add(box({0.2, 0.04, 0}, {0.4, 0.1, 0.02}));
    const std::vector<std::int32_t> group = groups(scene);
    EXPECT_NE(group[static_cast<std::size_t>(a)], group[static_cast<std::size_t>(b)]);
}

// The border of a board and a shelf's side is a staircase: columns of the board over the side, and
// of the side over the board, by chance.
TEST_P(Objects, WhatMeetsSideBySideDoesNotCarry) {
    Scene scene;
    const auto side = scene.add([](double x, double y, double z) {
        const double jag = std::fmod(std::abs(y), 0.08) < 0.04 ? 0.02 : 0;
        return x > 0.2 && x < 0.24 + (z < 0.52 ? jag : 0) && y > 0 && y < 0.32 && z > 0 && z < 0.8;
    });
    const auto board = scene.add(box({0.24, 0, 0.5}, {0.8, 0.32, 0.54}));
    const ContactGraph graph = contacts(scene);
    EXPECT_TRUE(graph.carriers_of(board).empty());
    ASSERT_EQ(graph.carriers_of(side).size(), 1u);
    EXPECT_EQ(graph.carriers_of(side)[0].supporter, 0);
}

// Of a box seen from the front only its front and top are known: nobody has seen that its rear does
// not stand.
TEST_P(Objects, WhatNobodySawMayStand) {
    Scene scene;
    const auto shell = scene.add([](double x, double y, double z) {
        return x > 0 && x < 0.2 && y > 0 && y < 0.2 && z > 0 && z < 0.3 && (y < 0.04 || z > 0.26);
    });
    scene.voxelise();
    const auto depth = [&] {
        const ContactGraph graph = contacts(scene);
        double high = -1;
        for (const auto& p : graph.carriers_of(shell)[0].outline) high = std::max(high, p[1]);
        return high;
    };
    EXPECT_NEAR(depth(), 0.04, 1e-9);
    scene.cells.unseen_below.assign(scene.cells.size(), 0);
    for (std::size_t n = 0; n < scene.cells.size(); ++n)
        if (scene.cells.primitive[n] == shell && scene.cells.k[n] == 13)
            scene.cells.unseen_below[n] = 20;
    EXPECT_NEAR(depth(), 0.2, 1e-9);
}

// Hidden behind another, a thing's foot is unseen: it stands on the floor. Where the floor under it
// is seen, it hangs, and what is near may hold it.
TEST_P(Objects, AHiddenFootStandsAndASeenGapHangs) {
    Scene scene;
    const auto thing = scene.add(box({0, 0, 0.2}, {0.2, 0.2, 0.4}));
    const auto wall = scene.add(box({0.26, -0.5, 0}, {0.3, 0.5, 1}));
    scene.voxelise();
    const ContactGraph hanging = contacts(scene);
    EXPECT_TRUE(hanging.carriers_of(thing).empty());
    EXPECT_TRUE(std::ranges::any_of(hanging.pairs, [&](const physics::TouchingPair& p) {
        return p.a == thing && p.b == wall;
    }));
    scene.cells.unseen_below.assign(scene.cells.size(), 0);
    for (std::size_t n = 0; n < scene.cells.size(); ++n)
        if (scene.cells.primitive[n] == thing && scene.cells.k[n] == 10)
            scene.cells.unseen_below[n] = 10;
    const ContactGraph standing = contacts(scene);
    ASSERT_EQ(standing.carriers_of(thing).size(), 1u);
    EXPECT_EQ(standing.carriers_of(thing)[0].supporter, 0);
    EXPECT_NEAR(standing.carriers_of(thing)[0].area_m2, 0.04, 1e-9);
}

// Noise between two slender boxes that would fall is no joint; a post there would be one.
// A board whose foot is 40 cm in front of a wall, or of nothing.
TEST_P(Objects, WhatLeansOnTheWallStands) {
    for (const bool wall : {true, false}) {
        Scene scene;
        const auto board = scene.add([](double x, double y, double z) {
            const double at = 0.4 * (1 - z);  // distance from the wall at this height
            return std::abs(x) < 0.15 && std::abs(y - at) < 0.02 && z > 0 && z < 1;
        });
        const auto behind = scene.add(box({-0.9, -0.06, 0}, {0.9, wall ? -0.02 : -0.04, 1.1}));
        if (wall) scene.shell.push_back(behind);
        const auto group = groups(scene);
        // Where it could not stand by itself it is taken for a part of something.
        EXPECT_EQ(
            group[static_cast<std::size_t>(board)] >= 0 &&
                group[static_cast<std::size_t>(board)] != group[static_cast<std::size_t>(behind)],
            wall);
    }
}

TEST_P(Objects, AScrapHoldsNothingTogether) {
    for (const bool post : {false, true}) {
        Scene scene;
        const auto a = scene.add(box({0, 0, 0}, {0.06, 0.2, 0.3}));
        const auto b = scene.add(box({0.14, 0, 0}, {0.2, 0.2, 0.3}));
        const double low = post ? 0 : 0.16;
        scene.add(box({0.06, 0.06, low}, {0.14, 0.14, 0.2}));
        const std::vector<std::int32_t> group = groups(scene);
        EXPECT_EQ(group[static_cast<std::size_t>(a)] == group[static_cast<std::size_t>(b)], post);
    }
}

// Neither of two trestles holds the plank alone, nor does the box beside them; and a book lies on
// a table that would hold it without the other book.
TEST_P(Objects, WhatCarriesTogetherWasMadeAsOne) {
    Scene scene;
    const auto left = scene.add(box({-0.5, -0.1, 0}, {-0.4, 0.1, 0.4}));
    const auto right = scene.add(box({0.4, -0.1, 0}, {0.5, 0.1, 0.4}));
    const auto plank = scene.add(box({-0.5, -0.1, 0.4}, {0.5, 0.1, 0.44}));
    const auto cup = scene.add(cylinder(0, 0, 0.04, 0.44, 0.54));
    const ContactGraph graph = contacts(scene);
    const std::vector<double> density(static_cast<std::size_t>(scene.count), 700);
    const auto bodies = physics::mass_properties(*device, scene.cells, scene.count, density);
    const Joinery joinery(graph, bodies, scene.seams, {true, false, false, false, false});
    EXPECT_EQ(joinery.made_as_one(left, plank), 1);
    EXPECT_EQ(joinery.made_as_one(plank, right), 1);
    EXPECT_EQ(joinery.made_as_one(plank, cup), 0);
    EXPECT_EQ(joinery.made_as_one(left, right), 0);
    EXPECT_EQ(joinery.made_as_one(0, left), 0);
}

// A sofa's arm covers the side of its seat; a box that barely reaches beside it does not, nor does
// the shell of the room, which furniture is pushed against.
TEST_P(Objects, SidesMateWhereOneCoversTheOther) {
    Scene scene;
    const auto seat = scene.add(box({-0.4, -0.3, 0}, {0.4, 0.3, 0.4}));
    const auto arm = scene.add(box({0.4, -0.3, 0}, {0.56, 0.3, 0.6}));
    const auto beside = scene.add(box({-0.6, 0.2, 0}, {-0.4, 0.5, 0.2}));
    const auto mat = scene.add(box({-0.2, -0.2, 0.4}, {0.2, 0.2, 0.42}));
    const ContactGraph graph = contacts(scene);
    const std::vector<double> density(static_cast<std::size_t>(scene.count), 700);
    const auto bodies = physics::mass_properties(*device, scene.cells, scene.count, density);
    const std::vector<bool> ground{true, false, false, false, false};
    const Joinery joinery(graph, bodies, scene.seams, ground);
    EXPECT_EQ(joinery.made_as_one(seat, arm), 1);
    EXPECT_EQ(joinery.made_as_one(seat, beside), 0);
    EXPECT_EQ(joinery.made_as_one(seat, mat), 0);
    const std::vector<bool> shell{true, false, true, false, false};
    EXPECT_EQ(Joinery(graph, bodies, scene.seams, shell).made_as_one(seat, arm), 0);
}

// The front of a shelf's side is flush with that of its board: some of its cells may be the
// board's, a ragged column down from it.
TEST_P(Objects, RaggedCellsAtAnEdgeHideNoMate) {
    Scene scene;
    const auto side = scene.add(box({-0.44, -0.2, 0}, {-0.4, 0.2, 0.6}));
    const auto board = scene.add([](double x, double y, double z) {
        const bool flat = std::abs(x) < 0.4 && std::abs(y) < 0.2 && z > 0.3 && z < 0.34;
        const bool ragged = x > -0.3 && x < -0.26 && y < -0.16 && y > -0.2 && z > 0.02 && z < 0.3;
        return flat || ragged || (x > 0.3 && x < 0.34 && y > 0 && y < 0.2 && z > 0 && z < 0.3);
    });
    const ContactGraph graph = contacts(scene);
    const std::vector<double> density(static_cast<std::size_t>(scene.count), 700);
    const auto bodies = physics::mass_properties(*device, scene.cells, scene.count, density);
    const Joinery joinery(graph, bodies, scene.seams, {true, false, false});
    const double end_m2 = graph.bulk_m2[static_cast<std::size_t>(board)][0];
    EXPECT_LT(end_m2, 0.75 * graph.silhouette_m2[static_cast<std::size_t>(board)][0]);
    EXPECT_EQ(joinery.made_as_one(side, board), 1);
}

// A screen above its table is not fixed to it through air that was seen.
TEST_P(Objects, AirThatWasSeenIsNoHiddenJoint) {
    Scene scene;
    const auto table = scene.add(box({-0.4, -0.3, 0}, {0.4, 0.3, 0.4}));
    const auto screen = scene.add(box({-0.2, -0.02, 0.46}, {0.2, 0.02, 0.7}));
    scene.voxelise();
    const auto joined = [&] {
        return std::ranges::any_of(contacts(scene).pairs, [&](const physics::TouchingPair& p) {
            return p.a == table && p.b == screen;
        });
    };
    scene.cells.unseen_below.assign(scene.cells.size(), 0);
    EXPECT_FALSE(joined());
    for (std::size_t n = 0; n < scene.cells.size(); ++n)
        if (scene.cells.primitive[n] == screen && scene.cells.k[n] == 23)
            scene.cells.unseen_below[n] = 3;
    EXPECT_TRUE(joined());
}

}  // namespace
}  // namespace topple::graph
