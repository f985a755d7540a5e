// SPDX-License-Identifier: MIT
#include "graph/supports.h"

#include "errors.h"
#include "graph/false_feet.h"
#include "host/graph/floor_scene.h"
#include "host/solids/cell_column.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::graph {
namespace {

using test::box;
using test::FloorScene;

// Each primitive is an object by itself; the floor is the ground.
class SupportsOf : public test::EachBackend {
  protected:
    std::vector<Support> supports(FloorScene& scene, double joint = 0) {
        const ContactGraph contacts = scene.contacts(*device);
        const std::vector<double> joints(contacts.pairs.size(), joint);
        std::vector<std::int32_t> object;
        std::vector<Carried> objects;
        for (const physics::MassProperties& body : scene.bodies(*device)) {
            objects.push_back({object.empty(), body.mass_kg});
            object.push_back(static_cast<std::int32_t>(object.size()));
        }
        return find_supports(contacts, joints, object, objects,
                             undersides(scene.cells, object, object.size()));
    }
};
TOPPLE_ON_EACH_BACKEND(SupportsOf);

TEST_P(SupportsOf, AStackAreThoseBelow) {
    FloorScene scene;
    const auto lower = scene.add(box({0, 0, 0}, {0.4, 0.4, 0.3}));
    const auto upper = scene.add(box({0.1, 0.1, 0.3}, {0.3, 0.3, 0.5}));
    const auto found = supports(scene);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].supporter, 0);
    EXPECT_EQ(found[0].supported, lower);
    EXPECT_NEAR(found[0].area_m2, 0.16, 1e-9);
    EXPECT_EQ(found[1].supporter, lower);
    EXPECT_EQ(found[1].supported, upper);
    EXPECT_GT(found[1].probability, 0.7);
}

TEST_P(SupportsOf, AGapThatNoiseLeavesIsBridged) {
    FloorScene scene;
    const auto thing = scene.add(box({0, 0, 0.06}, {0.2, 0.2, 0.3}));
    const auto found = supports(scene);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].supported, thing);
    EXPECT_NEAR(found[0].area_m2, 0.04, 1e-9);
}

TEST_P(SupportsOf, PiecesOfOneThingHardlyCarryEachOther) {
    FloorScene scene;
    scene.add(box({0, 0, 0}, {0.2, 0.2, 0.3}));
    scene.add(box({0, 0, 0.3}, {0.2, 0.2, 0.6}));
    const auto apart = supports(scene, 0), joined = supports(scene, 0.9);
    ASSERT_EQ(apart.size(), 2u);
    EXPECT_LT(joined.back().probability, apart.back().probability - 0.1);
}

// A heavy box on a post: hardly a support, but the only one that there is.
TEST_P(SupportsOf, WhatStandsOnLittleKeepsItsLikeliest) {
    FloorScene scene;
    const auto post = scene.add(box({0.1, 0.1, 0}, {0.2, 0.2, 0.5}));
    const auto thing = scene.add(box({0, 0, 0.5}, {0.3, 0.3, 0.8}));
    const auto found = supports(scene);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[1].supporter, post);
    EXPECT_EQ(found[1].supported, thing);
    EXPECT_GT(found[1].probability, 0.2);
    EXPECT_LT(found[1].probability, 0.5);
}

// Hooks that hang on one another: of each round the likeliest stay, and what carries the ring does.
TEST(Supports, ThreeDoNotHoldEachOtherUp) {
    ContactGraph contacts;
    contacts.primitives = 5;
    contacts.voxel_m = 0.02;
    const auto carries = [&](std::int32_t supporter, std::int32_t supported, double columns) {
        Carrying& c = contacts.carryings.emplace_back();
        c.supporter = supporter;
        c.supported = supported;
        c.area_m2 = columns * contacts.voxel_m * contacts.voxel_m;
    };
    carries(0, 1, 400);
    carries(1, 2, 900);
    carries(2, 3, 700);
    carries(3, 1, 500);  // the least of the round
    carries(3, 4, 600);
    carries(4, 3, 600);  // these two lean together
    const std::vector<std::int32_t> object{0, 1, 2, 3, 4};
    std::vector<Carried> objects(5, Carried{false, 2});
    objects[0].grounded = true;
    const auto found =
        find_supports(contacts, {}, object, objects, std::vector<std::vector<Underside>>(5));
    std::vector<std::array<std::int32_t, 2>> pairs;
    for (const Support& s : found) pairs.push_back({s.supporter, s.supported});
    EXPECT_THAT(pairs,
                ::testing::UnorderedElementsAreArray(std::vector<std::array<std::int32_t, 2>>{
                    {0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 3}}));
}

// A cup on a bed on the floor; rays went on to below the bed.
TEST(FalseFeet, WhatWasFilledBelowWhatCarriesAThingIsNotItsOwn) {
    constexpr std::int32_t floor = 0, bed = 1, cup = 2, handle = 3;
    SolidCells cells;
    cells.voxel_m = 0.02;
    test::add_column(cells, 0, 0, 1, floor, Basis::surface);
    test::add_column(cells, 0, 1, 2, cup, Basis::half_enclosed);
    test::add_column(cells, 0, 20, 25, bed, Basis::half_enclosed);
    test::add_column(cells, 0, 25, 30, cup, Basis::surface);
    test::add_column(cells, 1, 26, 29, handle, Basis::surface);
    test::add_column(cells, 2, 0, 1, floor, Basis::half_enclosed);
    test::add_column(cells, 2, 1, 3, floor, Basis::half_enclosed);
    BoundaryCells boundary;
    for (const auto& [k, primitive] : {std::pair{1, cup}, {25, cup}, {30, cup}}) {
        boundary.i.push_back(0);
        boundary.j.push_back(0);
        boundary.k.push_back(k);
        boundary.primitive.push_back(primitive);
        boundary.form.push_back(0);
        boundary.share.push_back(static_cast<std::uint32_t>(k));
        for (auto& slot : boundary.slot) slot.push_back(0);
        for (auto& moment : boundary.moment) moment.push_back(0);
    }
    const auto solids = std::make_shared<const SolidScene>(
        cells, std::vector<Role>{Role::floor, Role::none, Role::none, Role::none}, SolidCells{},
        boundary);
    const std::vector<std::int32_t> object{0, 1, 2, 2};
    const auto out = without_false_feet(solids, object, 0);
    ASSERT_EQ(out->cells().size(), cells.size());
    for (std::size_t n = 0; n < cells.size(); ++n)
        EXPECT_EQ(out->cells().primitive[n], n == 1 ? -1 : cells.primitive[n]) << n;
    EXPECT_EQ(out->boundary().share, (std::vector<std::uint32_t>{25, 30}));
    EXPECT_EQ(out->role(floor), Role::floor);

    // Up to the bed it may be the cup's own foot, which nobody saw.
    const std::vector<std::int32_t> one{0, 2, 2, 2};
    EXPECT_EQ(without_false_feet(solids, one, 0)->cells().primitive[1], -1);
    SolidCells near = cells;
    near.k[1] = 17;
    const auto standing = std::make_shared<const SolidScene>(
        near, std::vector<Role>{Role::floor, Role::none, Role::none, Role::none});
    EXPECT_EQ(without_false_feet(standing, one, 0), standing) << "the same solids";
}

// A kettle on a counter: cells down to the floor, of which its surfaces leave nothing, are no foot,
// but for a few, as noise makes.
TEST(FalseFeet, WhatItsSurfacesLeaveNothingOfIsNoFoot) {
    constexpr std::int32_t floor = 0, kettle = 1, solid_from = 12;
    for (const std::int32_t lowest : {1, 10}) {
        SolidCells cells;
        cells.voxel_m = 0.02;
        test::add_column(cells, 0, 0, 1, floor, Basis::surface);
        test::add_column(cells, 0, lowest, 20, kettle, Basis::surface);
        BoundaryCells boundary;
        for (std::int32_t k = lowest; k < solid_from; ++k) {
            boundary.i.push_back(0);
            boundary.j.push_back(0);
            boundary.k.push_back(k);
            boundary.primitive.push_back(kettle);
            boundary.form.push_back(0);
            boundary.share.push_back(0);
            for (auto& slot : boundary.slot) slot.push_back(0);
            for (auto& moment : boundary.moment) moment.push_back(0);
        }
        const auto solids = std::make_shared<const SolidScene>(
            cells, std::vector<Role>{Role::floor, Role::none}, SolidCells{}, boundary);
        const auto out = without_false_feet(solids, std::vector<std::int32_t>{0, 1}, 0);
        for (std::size_t n = 1; n < cells.size(); ++n)
            EXPECT_EQ(out->cells().primitive[n],
                      lowest == 1 && cells.k[n] < solid_from ? -1 : kettle)
                << cells.k[n];
    }
}

class Contacts : public test::EachBackend {};
TOPPLE_ON_EACH_BACKEND(Contacts);

// The border of a board and a shelf's side is a staircase: columns of the board over the side, and
// of the side over the board, by chance.
TEST_P(Contacts, WhatMeetsSideBySideDoesNotCarry) {
    test::FloorScene scene;
    const auto side = scene.add([](double x, double y, double z) {
        const double jag = std::fmod(std::abs(y), 0.08) < 0.04 ? 0.02 : 0;
        return x > 0.2 && x < 0.24 + (z < 0.52 ? jag : 0) && y > 0 && y < 0.32 && z > 0 && z < 0.8;
    });
    const auto board = scene.add(box({0.24, 0, 0.5}, {0.8, 0.32, 0.54}));
    const ContactGraph graph = scene.contacts(*device);
    EXPECT_TRUE(graph.carriers_of(board).empty());
    ASSERT_EQ(graph.carriers_of(side).size(), 1u);
    EXPECT_EQ(graph.carriers_of(side)[0].supporter, 0);
}

// Of a box seen from the front only its front and top are known: nobody has seen that its rear does
// not stand.
TEST_P(Contacts, WhatNobodySawMayStand) {
    test::FloorScene scene;
    const auto shell = scene.add([](double x, double y, double z) {
        return x > 0 && x < 0.2 && y > 0 && y < 0.2 && z > 0 && z < 0.3 && (y < 0.04 || z > 0.26);
    });
    scene.voxelise();
    const auto depth = [&] {
        const ContactGraph graph = scene.contacts(*device);
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

// A box half over the edge of a post: below the half in the air nobody has seen, but the post has
// ended there.
TEST_P(Contacts, WhatNobodySawCarriesNotBeyondTheSupport) {
    test::FloorScene scene;
    const auto post = scene.add(box({0, 0, 0}, {0.2, 0.2, 0.4}));
    const auto thing = scene.add(box({0.1, 0, 0.4}, {0.3, 0.2, 0.6}));
    scene.voxelise();
    scene.cells.unseen_below.assign(scene.cells.size(), 20);
    const ContactGraph graph = scene.contacts(*device);
    ASSERT_EQ(graph.carriers_of(thing).size(), 1u);
    EXPECT_EQ(graph.carriers_of(thing)[0].supporter, post);
    for (const auto& point : graph.carriers_of(thing)[0].outline) EXPECT_LE(point[0], 0.2 + 1e-9);
}

// Hidden behind another, a thing's foot is unseen: it stands on the floor. Where the floor under it
// is seen, it hangs, and what is near may hold it.
TEST_P(Contacts, AHiddenFootStandsAndASeenGapHangs) {
    test::FloorScene scene;
    const auto thing = scene.add(box({0, 0, 0.2}, {0.2, 0.2, 0.4}));
    const auto wall = scene.add(box({0.26, -0.5, 0}, {0.3, 0.5, 1}));
    scene.voxelise();
    const ContactGraph hanging = scene.contacts(*device);
    EXPECT_TRUE(hanging.carriers_of(thing).empty());
    EXPECT_TRUE(std::ranges::any_of(hanging.pairs, [&](const physics::TouchingPair& p) {
        return p.a == thing && p.b == wall;
    }));
    scene.cells.unseen_below.assign(scene.cells.size(), 0);
    for (std::size_t n = 0; n < scene.cells.size(); ++n)
        if (scene.cells.primitive[n] == thing && scene.cells.k[n] == 10)
            scene.cells.unseen_below[n] = 10;
    const ContactGraph standing = scene.contacts(*device);
    ASSERT_EQ(standing.carriers_of(thing).size(), 1u);
    EXPECT_EQ(standing.carriers_of(thing)[0].supporter, 0);
    EXPECT_NEAR(standing.carriers_of(thing)[0].area_m2, 0.04, 1e-9);
}

// A screen above its table is not fixed to it through air that was seen.
TEST_P(Contacts, AirThatWasSeenIsNoHiddenJoint) {
    test::FloorScene scene;
    const auto table = scene.add(box({-0.4, -0.3, 0}, {0.4, 0.3, 0.4}));
    const auto screen = scene.add(box({-0.2, -0.02, 0.46}, {0.2, 0.02, 0.7}));
    scene.voxelise();
    const auto joined = [&] {
        return std::ranges::any_of(
            scene.contacts(*device).pairs,
            [&](const physics::TouchingPair& p) { return p.a == table && p.b == screen; });
    };
    scene.cells.unseen_below.assign(scene.cells.size(), 0);
    EXPECT_FALSE(joined());
    for (std::size_t n = 0; n < scene.cells.size(); ++n)
        if (scene.cells.primitive[n] == screen && scene.cells.k[n] == 23)
            scene.cells.unseen_below[n] = 3;
    EXPECT_TRUE(joined());
}

// A table seen along x and y is its top and two legs; along z its top hides them.
TEST_P(Contacts, SilhouettesCountEachLineOnce) {
    test::FloorScene scene;
    const auto table = scene.add([](double x, double y, double z) {
        if (std::abs(x) > 0.4 || std::abs(y) > 0.3 || z < 0 || z > 0.44) return false;
        return z > 0.4 || (std::abs(x) > 0.36 && std::abs(y) > 0.26);
    });
    const auto area = scene.contacts(*device).silhouette_m2[table];
    EXPECT_NEAR(area[0], 0.6 * 0.04 + 2 * 0.04 * 0.4, 1e-9);
    EXPECT_NEAR(area[1], 0.8 * 0.04 + 2 * 0.04 * 0.4, 1e-9);
    EXPECT_NEAR(area[2], 0.8 * 0.6, 1e-9);
}

}  // namespace
}  // namespace topple::graph
