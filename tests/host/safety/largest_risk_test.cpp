// SPDX-License-Identifier: MIT
#include "safety/largest_risk.h"

#include <gtest/gtest.h>

#include <limits>

namespace topple::safety {
namespace {

TEST(LargestRisk, is_by_one_of_the_kinds) {
    Object o;
    EXPECT_EQ(largest_risk(o).kind, nullptr);
    o.risk_J = {{"human", 0}, {"wind", std::numeric_limits<double>::quiet_NaN()}};
    EXPECT_EQ(largest_risk(o).kind, nullptr);
    EXPECT_EQ(largest_risk(o).risk_J, 0);
    o.risk_J = {{"earthquake", 2}, {"human", 3}, {"wind", 3}, {"flood", 9}};
    ASSERT_NE(largest_risk(o).kind, nullptr);
    EXPECT_STREQ(largest_risk(o).kind->name, "human");
    EXPECT_EQ(largest_risk(o).risk_J, 3);
}

}  // namespace
}  // namespace topple::safety
