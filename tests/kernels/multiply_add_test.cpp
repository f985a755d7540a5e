// SPDX-License-Identifier: MIT
#include "multiply_add.hpp"

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/multiply_add_oracle.h"

namespace topple::test {
namespace {

class MultiplyAdd : public EachBackend {};
TOPPLE_ON_EACH_FORM(MultiplyAdd);

// The count is a multiple of the elements that one work-item holds.
TEST_P(MultiplyAdd, MatchesTheOracle) {
    const std::uint32_t items = device->items_per_lane(kernels::MultiplyAdd::source());
    for (const std::uint32_t lanes : {0u, 1u, 63u, 64u, 65u, 101u}) {
        for (const std::uint32_t rounds : {0u, 1u, 1000u}) {
            SCOPED_TRACE(std::to_string(lanes) + " work-items, " + std::to_string(rounds) +
                         " rounds");
            const std::uint32_t count = lanes * items;
            const std::vector<float> x = Random(lanes).floats(count, -600, 600);
            Guarded<float> array(*device, count, "x");
            array.upload(x);
            device::Queue queue(*device);
            queue.add<kernels::MultiplyAdd>(count, {.x = array.slice()},
                                            {.count = count, .rounds = rounds});
            queue.run();
            std::vector<double> want, bound;
            oracle::multiply_add(x, rounds, want, bound);
            EXPECT_TRUE(within(array.download(), want, bound));
            EXPECT_TRUE(array.untouched());
        }
    }
}

}  // namespace
}  // namespace topple::test
