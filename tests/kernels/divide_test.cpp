// SPDX-License-Identifier: MIT
#include "divide.hpp"

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/divide_oracle.h"

namespace topple::test {
namespace {

class Divide : public EachBackend {};
TOPPLE_ON_EACH_FORM(Divide);

// The count is a multiple of the elements that one work-item holds.
TEST_P(Divide, MatchesTheOracle) {
    const std::uint32_t items = device->items_per_lane(kernels::Divide::source());
    for (const std::uint32_t lanes : {0u, 1u, 63u, 64u, 65u}) {
        for (const std::uint32_t rounds : {0u, 1u, 333u}) {
            SCOPED_TRACE(std::to_string(lanes) + " work-items, " + std::to_string(rounds) +
                         " rounds");
            const std::uint32_t count = lanes * items;
            const std::vector<float> x = Random(lanes).floats(count, 0.01, 50);
            Guarded<float> array(*device, count, "x");
            array.upload(x);
            device::Queue queue(*device);
            queue.add<kernels::Divide>(count, {.x = array.slice()},
                                       {.count = count, .rounds = rounds});
            queue.run();
            std::vector<double> want, bound;
            oracle::divide(x, rounds, want, bound);
            EXPECT_TRUE(within(array.download(), want, bound));
            EXPECT_TRUE(array.untouched());
        }
    }
}

}  // namespace
}  // namespace topple::test
