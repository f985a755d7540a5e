// SPDX-License-Identifier: MIT
#include "triad.hpp"

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/triad_oracle.h"

namespace topple::test {
namespace {

class Triad : public EachBackend {};
TOPPLE_ON_EACH_FORM(Triad);

TEST_P(Triad, MatchesTheOracle) {
    for (const std::size_t count : {0, 1, 63, 64, 65, 997, 100'003}) {
        SCOPED_TRACE(count);
        Random random(count);
        const std::vector<float> a = random.floats(count, -3, 3), b = random.floats(count, -3, 3);
        const device::Buffer<float> in_a(*device, a, "a"), in_b(*device, b, "b");
        const Guarded<float> out(*device, count, "dst");
        device::Queue queue(*device);
        queue.add<kernels::Triad>(count, {.a = in_a, .b = in_b, .dst = out.slice()},
                                  {.count = static_cast<std::uint32_t>(count), .scale = 1.7f});
        queue.run();
        std::vector<double> want, bound;
        oracle::triad(a, b, 1.7f, want, bound);
        EXPECT_TRUE(within(out.download(), want, bound));
        EXPECT_TRUE(out.untouched());
    }
}

}  // namespace
}  // namespace topple::test
