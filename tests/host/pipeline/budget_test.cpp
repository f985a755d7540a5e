// SPDX-License-Identifier: MIT
#include "points/budget.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "core/process_memory.h"
#include "topple/error.h"

namespace topple {
namespace {

TEST(Budget, IsByTheOptionsElseByTheInputAndTheMachine) {
    ParseOptions options;
    const std::uint64_t free = memory_left();
    EXPECT_GT(free, 0U);
    EXPECT_EQ(Budget::current(), nullptr);
    for (const auto& [input, most] :
         {std::pair{std::uint64_t{134}, 2e9}, {1'000'000, 2e9}, {1'000'001, 4e9}}) {
        const Budget budget("scan", input, options);
        EXPECT_EQ(Budget::current(), &budget);
        EXPECT_LE(static_cast<double>(budget.bytes()), most);
        EXPECT_FALSE(budget.asked());
    }
    options.max_memory_bytes = 1 << 20;
    const Budget asked("scan", 134, options);
    EXPECT_EQ(asked.bytes(), options.max_memory_bytes);
    EXPECT_TRUE(asked.asked());
    EXPECT_EQ(memory_bound_text(options), "1 MiB of ParseOptions::max_memory_bytes");
    EXPECT_NO_THROW(asked.check("it takes", 1 << 20, "take less"));
    EXPECT_THROW(asked.check("it takes", (1 << 20) + 1, "take less"), Error);
}

TEST(Budget, EndsWhatTakesMoreWhereItPolls) {
    ParseOptions options;
    options.max_memory_bytes = Budget::least_bytes;
    Budget budget("scan", 134, options);
    const ParseOptions polled = budget.polled();
    const auto poll = [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return polled.cancelled();
    };
    polled.progress("filling", 0);
    EXPECT_FALSE(poll());
    const std::vector<char> taken(2 * Budget::least_bytes, 1);
    try {
        poll();
        FAIL() << "took " << taken.size();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "scan: in the stage \"filling\" its points take more than the 256 MiB of "
                     "ParseOptions::max_memory_bytes: allow more, or give fewer points");
    }
}

TEST(Budget, TellsOnceOfWorkThatIsLongForItsInput) {
    std::vector<std::string> told;
    ParseOptions options;
    options.notice = [&](const std::string& line) { told.push_back(line); };
    Budget budget("scan", 134, options);
    budget.begin_work("9 voxels", "use fewer", 5);
    EXPECT_TRUE(told.empty());
    for (int n = 0; n < 2; ++n) budget.begin_work("9 voxels", "use fewer", 630);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_NE(told[0].find("scan: 9 voxels take about 11 min of"), std::string::npos) << told[0];
}

}  // namespace
}  // namespace topple
