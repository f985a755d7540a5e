#include "smooth.hpp"

#include "smooth_oracle.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernel_testing/random.h"

namespace {

using topple::device::Buffer;
using topple::test::Guarded;

class Smooth : public topple::test::EachBackend {};
TOPPLE_ON_EACH_FORM(Smooth);

TEST_P(Smooth, MatchesTheOracle) {
    for (const std::size_t count : {1u, 2u, 63u, 64u, 65u, 997u}) {
        SCOPED_TRACE(count);
        topple::test::Random random(count);
        const std::vector<float> heights = random.floats(count, -2, 2);
        const std::vector<float> weights = random.floats(count, 0.1f, 9);
        const Buffer<float> height(*device, heights, "height"), weight(*device, weights, "weight");
        const Guarded<float> smoothed(*device, count, "smoothed");
        topple::test::run_kernel<my_app::Smooth>(
            *device, count, {.height = height, .weight = weight, .smoothed = smoothed.slice()},
            {.count = static_cast<std::uint32_t>(count)});
        const Smoothed want = smooth_oracle(heights, weights);
        EXPECT_TRUE(topple::test::within(smoothed.download(), want.mean, want.bound));
        EXPECT_TRUE(smoothed.untouched());
    }
}

}  // namespace
