// SPDX-License-Identifier: MIT
#include "core/sorted_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/random.h"

namespace topple {
namespace {

TEST(SortedOrder, IsThatOfAStableSortWhateverTheThreads) {
    Random random(1);
    for (const std::size_t count : {0, 1, 65'535, 65'536, 65'537, 300'000}) {
        for (const bool wide : {false, true}) {
            SCOPED_TRACE(testing::Message() << count << (wide ? " wide keys" : " keys"));
            std::vector<std::uint64_t> keys(count);
            for (auto& key : keys) key = wide ? random.bits() : random.below(5000);
            std::vector<std::uint32_t> wanted(count);
            std::iota(wanted.begin(), wanted.end(), 0U);
            std::ranges::stable_sort(wanted, {}, [&](std::uint32_t n) { return keys[n]; });
            EXPECT_TRUE(sorted_order(keys) == wanted);
            for (const unsigned threads : {2U, 3U}) {
                ThreadPool pool(threads);
                EXPECT_TRUE(sorted_order(keys, pool) == wanted);
            }
        }
    }
}

}  // namespace
}  // namespace topple
