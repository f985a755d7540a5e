// SPDX-License-Identifier: MIT
#include "safety/unsafety_category.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace topple::safety {
namespace {

// The table of docs/output.md, by rows from likely to rare and columns from negligible to deadly.
TEST(UnsafetyCategory, IsTheTable) {
    constexpr Category none = Category::none, low = Category::low, medium = Category::medium,
                       high = Category::high;
    const double chances[] = {0.1, 0.01, 0.001, 0.0009, 0};
    const double energies[] = {0.99, 1, 15, 79};
    const Category expected[5][4] = {{none, medium, high, high},
                                     {none, low, medium, high},
                                     {none, low, low, medium},
                                     {none, none, low, low},
                                     {none, none, none, none}};
    for (int c = 0; c < 5; ++c) {
        for (int e = 0; e < 4; ++e)
            EXPECT_EQ(category(chances[c], energies[e]), expected[c][e])
                << chances[c] << " " << energies[e];
    }
    EXPECT_EQ(category(1, 1000), high);
    EXPECT_EQ(category(0.0999, 14.9), low);
}

TEST(UnsafetyCategory, NeverFallsWithChanceOrEnergy) {
    for (double chance = 1e-5; chance < 1; chance *= 1.7) {
        for (double energy = 0.1; energy < 500; energy *= 1.7) {
            EXPECT_LE(category(chance, energy), category(1.7 * chance, energy));
            EXPECT_LE(category(chance, energy), category(chance, 1.7 * energy));
        }
    }
}

TEST(UnsafetyCategory, OfARiskTakesTheMeanEnergyOfAFall) {
    Risk risk;
    risk.chance = 0.02;
    risk.mean_J = 0.02 * 14;
    EXPECT_EQ(category(risk, 1), Category::low);
    EXPECT_EQ(category(risk, 1.1), Category::medium) << "10 % more mass makes it 15.4 J";
    EXPECT_EQ(category(Risk{}, 1), Category::none);
    risk.mean_J = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(category(risk, 1), Category::none);
    EXPECT_STREQ(to_string(Category::high), "high");
    EXPECT_STREQ(to_string(Category::none), "none");
}

// A shelf before a wall, whose foot, one error smaller, lets it lean on that and never fall.
TEST(UnsafetyCategory, IsTheWorstOfWhatWasMeasuredAndOfBothEnds) {
    const Risk measured{26.3, 0, 0.0156};
    CategoryEnds ends;
    EXPECT_EQ(ends.worst(), Category::none);
    EXPECT_TRUE(ends.certain());
    ends.measured = category(measured, 1);
    EXPECT_EQ(ends.worst(), Category::high);
    EXPECT_FALSE(ends.certain());
    ends.lower = ends.higher = Category::high;
    EXPECT_TRUE(ends.certain());
    ends.measured = Category::low;
    EXPECT_EQ(ends.worst(), Category::high);
    EXPECT_FALSE(ends.certain());
}

}  // namespace
}  // namespace topple::safety
