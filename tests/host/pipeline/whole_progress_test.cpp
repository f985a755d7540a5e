// SPDX-License-Identifier: MIT
#include "pipeline/whole_progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "host/pipeline/small_room.h"

namespace topple::test {
namespace {

using Told = std::vector<std::pair<std::string, double>>;

void expect_rising(const Told& told) {
    ASSERT_FALSE(told.empty());
    for (std::size_t n = 1; n < told.size(); ++n)
        EXPECT_GE(told[n].second, told[n - 1].second) << told[n].first;
    EXPECT_GE(told.front().second, 0);
    EXPECT_EQ(told.back().second, 1);
}

ParseOptions telling(Told& told) {
    ParseOptions options;
    options.device = device::open_device("native", 2);
    options.progress = [&](const std::string& stage, double done) {
        told.emplace_back(stage, done);
    };
    return options;
}

TEST(WholeProgress, RisesOverTheStagesOfAParse) {
    Told told;
    ParseOptions options = telling(told);
    options.disturbances = {"wind"};
    const ParseResult result = parse(SmallRoom::scattered().cloud, options);
    expect_rising(told);
    // A stage takes the share that it takes of typical parses: most are seen to have some.
    std::size_t moved = 0;
    for (std::size_t n = 1; n < told.size(); ++n) moved += told[n].second > told[n - 1].second;
    EXPECT_GT(moved, result.scene.timings_s.size() / 2);
    for (const auto& [stage, seconds] : result.scene.timings_s)
        EXPECT_TRUE(std::ranges::find(told, stage, &Told::value_type::first) != told.end());
}

TEST(WholeProgress, GoesOnWhereStagesAreSkippedOrUnknown) {
    ParseOptions options;
    options.disturbances = {};
    WholeProgress whole(WholeProgress::Input::frames, options);
    const double early = whole("cache", 1), grouping = whole("grouping", 0);
    EXPECT_LT(early, 0.1);
    EXPECT_EQ(grouping, early);
    const double half = whole("grouping", 0.5);
    EXPECT_GT(half, grouping);
    EXPECT_EQ(whole("grouping", 0.2), half);
    EXPECT_EQ(whole("grouping", -1e9), half);
    EXPECT_GE(whole("polishing", 0.9), half);
    const double late = whole("risk", 0);
    EXPECT_GT(late, half);
    EXPECT_LT(late, 1);
    const double again = whole("grouping", 0);  // risk is done by now
    EXPECT_GE(again, late);
    EXPECT_EQ(whole("grouping", 1), again);
    EXPECT_EQ(whole("assembly", 0), again);
    EXPECT_NEAR(whole("assembly", 7), 1, 1e-12);
}

// Of a cloud that turns out to be small after it was sorted, and of one that is parsed in blocks.
TEST(WholeProgress, CloudsInBlocksHaveStagesOfTheirOwn) {
    WholeProgress small(WholeProgress::Input::cloud, {}), large(WholeProgress::Input::cloud, {});
    EXPECT_EQ(small("sorting", 0), 0);
    const double sorted = large("sorting", 1);
    EXPECT_GT(sorted, 0);
    EXPECT_EQ(small("sorting", 1), sorted);
    EXPECT_GT(small("ingest", 0.5), sorted);
    EXPECT_GT(large("blocks", 1) - sorted, 0.3);
    EXPECT_LT(large("bodies", 0), 1);
}

}  // namespace
}  // namespace topple::test
