// SPDX-License-Identifier: MIT
#include "gather.hpp"

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/gather_oracle.h"

namespace topple::test {
namespace {

class Gather : public EachBackend {};
TOPPLE_ON_EACH_FORM(Gather);

// The count is a multiple of the elements that one work-item holds.
TEST_P(Gather, MatchesTheOracle) {
    const std::uint32_t items = device->items_per_lane(kernels::Gather::source());
    const std::uint32_t shift = 25;
    std::vector<std::uint32_t> table(1u << (32 - shift));
    Random random(3);
    for (std::uint32_t& word : table) word = static_cast<std::uint32_t>(random.word());
    const device::Buffer<std::uint32_t> words(*device, table, "table");
    for (const std::uint32_t lanes : {0u, 1u, 63u, 64u, 65u}) {
        for (const std::uint32_t rounds : {0u, 1u, 77u}) {
            SCOPED_TRACE(std::to_string(lanes) + " work-items, " + std::to_string(rounds) +
                         " rounds");
            const std::uint32_t count = lanes * items;
            Guarded<std::uint32_t> sum(*device, count, "sum");
            device::Queue queue(*device);
            queue.add<kernels::Gather>(count, {.table = words, .sum = sum.slice()},
                                       {.count = count, .rounds = rounds, .shift = shift});
            queue.run();
            EXPECT_EQ(sum.download(), oracle::gather(table, count, rounds));
            EXPECT_TRUE(sum.untouched());
        }
    }
}

}  // namespace
}  // namespace topple::test
