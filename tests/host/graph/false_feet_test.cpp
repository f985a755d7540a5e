// SPDX-License-Identifier: MIT
#include "graph/false_feet.h"

#include <gtest/gtest.h>

#include <vector>

#include "host/solids/cell_column.h"

namespace topple::graph {
namespace {

// A cup on a bed on the floor; rays went on to below the bed.
TEST(FalseFeet, WhatWasFilledBelowWhatCarriesAThingIsNotItsOwn) {
    constexpr std::int32_t floor = 0, bed = 1, cup = 2, handle = 3;
    SolidCells cells;
    cells.voxel_m = 0.02;
    test::add_column(cells, 0, 0, 1, floor, Basis::surface);
    test::add_column(cells, 0, 1, 2, cup, Basis::two_votes);
    test::add_column(cells, 0, 20, 25, bed, Basis::two_votes);
    test::add_column(cells, 0, 25, 30, cup, Basis::surface);
    test::add_column(cells, 1, 26, 29, handle, Basis::surface);
    test::add_column(cells, 2, 0, 1, floor, Basis::two_votes);
    test::add_column(cells, 2, 1, 3, floor, Basis::two_votes);
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

}  // namespace
}  // namespace topple::graph
