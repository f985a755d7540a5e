// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "physics/repeated_objects.h"

namespace topple::physics {
namespace {

FurnitureLooks box(double height, double depth, double width, double fill, double backing) {
    return {.height_m = height,
            .fill = fill,
            .backing = backing,
            .box_side_m2 = 0,
            .box_m = {depth, width}};
}

// Two bookcases, one with a wall behind it that was seen; a table; another, of which half was seen.
const std::vector<FurnitureLooks> things{box(2, 0.4, 1, 0.9, 1),
                                         box(2.1, 0.44, 1.05, 0.9, 0),
                                         box(0.75, 0.8, 1.6, 0.3, 0),
                                         box(2, 0.4, 0.5, 0.9, 0),
                                         {}};

TEST(Repeated, BoxesOfTheSameSidesAre) {
    const Repeated alike = find_repeated(things);
    EXPECT_EQ(alike[0], std::vector<std::int32_t>{1});
    EXPECT_EQ(alike[1], std::vector<std::int32_t>{0});
    for (const std::size_t other : {2u, 3u, 4u}) EXPECT_TRUE(alike[other].empty()) << other;
    EXPECT_TRUE(find_repeated(std::vector<FurnitureLooks>(2))[0].empty()) << "nothing has no box";
}

TEST(Repeated, AreClosedTogether) {
    const std::vector<ClosedOdds> p = closed_odds(things, find_repeated(things));
    const auto log_odds = [](double x) { return std::log(x / (1 - x)); };
    const double both = log_odds(probability_closed(things[0])) +
                        log_odds(probability_closed(things[1])) - log_odds(closed_share);
    EXPECT_GT(probability_closed(things[0]), 0.5);
    EXPECT_LT(probability_closed(things[1]), 0.5);
    EXPECT_NEAR(log_odds(p[0].probability), both, 1e-9);
    EXPECT_NEAR(log_odds(p[1].probability), both, 1e-9);
    EXPECT_NEAR(p[3].probability, probability_closed(things[3]), 1e-12);
    EXPECT_EQ(p[4].probability, 0);
}

// What fills too little of its box to tell has no say.
TEST(Repeated, NeedToFillTheirBoxes) {
    std::vector<FurnitureLooks> some{things[0], things[1]};
    some[1].fill = 0.1;
    const std::vector<ClosedOdds> p = closed_odds(some, find_repeated(some));
    EXPECT_NEAR(p[0].probability, probability_closed(some[0]), 1e-12);
    EXPECT_EQ(p[1].probability, 0);
}

// A wall that a voxel more or less brings within reach tells now one kind, now the other.
TEST(Repeated, WhereVoxelsFallMayTellTheOtherKind) {
    for (const double usual : {0.0, 1.0}) {
        FurnitureLooks near = box(1.2, 0.3, 0.3, 1, usual);
        const auto closed_ways = [&] {
            return closed_odds(std::vector<FurnitureLooks>{near}, Repeated(1))[0].closed_ways;
        };
        near.backing_range = {0, 1};
        EXPECT_NEAR(closed_ways(), (1 + usual) / 3, 1e-3);
        near.backing_range = {usual, usual};
        EXPECT_EQ(closed_ways(), usual);
    }
}

TEST(Repeated, MassesShowTheirError) {
    const std::vector<double> mass{50, 100, 3};
    const double off = std::log(2.0) / std::sqrt(2.0);
    const std::vector<std::int32_t> other{1};
    EXPECT_NEAR(error_among_alike_kg(mass, other, 0), 50 * (1 - std::exp(-off)), 1e-9);
    EXPECT_NEAR(error_among_alike_kg(mass, {}, 2), 0, 0);
    const std::vector<double> same{50, 50};
    EXPECT_EQ(error_among_alike_kg(same, other, 0), 0);
}

}  // namespace
}  // namespace topple::physics
