// SPDX-License-Identifier: MIT
#include "host/api/c_api.h"
#include "topple/compare.h"

// Comparisons in C are those of C++.
namespace topple::test {
namespace {

TEST_F(CApi, AComparisonIsThatOfCpp) {
    ASSERT_EQ(parsed(), TOPPLE_OK) << status.message;
    const std::string a = path("a"), b = path("b");
    for (const std::string& folder : {a, b})
        ASSERT_EQ(topple_result_write(result, folder.c_str(), 0, &status), TOPPLE_OK)
            << status.message;
    topple_comparison* comparison = nullptr;
    std::uint64_t things = 0;
    ASSERT_EQ(topple_compare(a.c_str(), b.c_str(), &comparison, &things, &status), TOPPLE_OK)
        << status.message;
    const Comparison expected = compare(a, b);
    ASSERT_EQ(things, expected.things.size());
    ASSERT_GT(things, 0u);
    topple_alignment alignment{};
    alignment.size = sizeof(alignment);
    ASSERT_EQ(topple_comparison_alignment(comparison, &alignment, &status), TOPPLE_OK);
    EXPECT_TRUE(std::ranges::equal(alignment.a_from_b, expected.alignment.a_from_b));
    EXPECT_EQ(alignment.same_frame, 1);
    EXPECT_EQ(alignment.agreeing, expected.alignment.agreeing);
    topple_compared_thing thing{};
    thing.size = sizeof(thing);
    for (std::uint64_t n = 0; n < things; ++n) {
        ASSERT_EQ(topple_comparison_thing(comparison, n, &thing, &status), TOPPLE_OK);
        EXPECT_EQ(thing.a, expected.things[n].a);
        EXPECT_EQ(thing.b, expected.things[n].b);
        EXPECT_EQ(thing.became, int(expected.things[n].became));
        EXPECT_EQ(thing.solid, expected.things[n].solid);
    }
    EXPECT_EQ(topple_comparison_thing(comparison, things, &thing, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_comparison_alignment(nullptr, &alignment, &status), TOPPLE_ERROR_USAGE);
    topple_comparison_release(comparison);
    topple_comparison_release(nullptr);
    EXPECT_EQ(topple_compare(a.c_str(), path("missing").c_str(), &comparison, &things, &status),
              TOPPLE_ERROR_INPUT);
    EXPECT_EQ(comparison, nullptr);
    EXPECT_EQ(topple_compare(a.c_str(), nullptr, &comparison, nullptr, &status),
              TOPPLE_ERROR_USAGE);
}

}  // namespace
}  // namespace topple::test
