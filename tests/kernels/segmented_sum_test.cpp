// SPDX-License-Identifier: MIT
#include "segmented_sum.hpp"

#include <numeric>

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/segmented_sum_oracle.h"

namespace topple::test {
namespace {

class SegmentedSum : public EachBackend {
  protected:
    void check(const std::vector<std::uint32_t>& lengths, std::int32_t origin,
               std::uint32_t extent) {
        std::vector<std::uint32_t> first{0};
        for (const std::uint32_t n : lengths) first.push_back(first.back() + n);
        const std::uint32_t cells = first.back();
        Random random(cells + 1);
        std::vector<std::int32_t> axis[3];
        for (auto& a : axis) {
            for (std::uint32_t n = 0; n < cells; ++n) {
                a.push_back(origin + static_cast<std::int32_t>(random.word() % extent));
            }
        }
        std::vector<std::uint32_t> order(cells);
        std::iota(order.begin(), order.end(), 0U);
        for (std::uint32_t n = cells; n > 1; --n) std::swap(order[n - 1], order[random.word() % n]);
        const device::Buffer<std::int32_t> ci(*device, axis[0], "ci"), cj(*device, axis[1], "cj"),
            ck(*device, axis[2], "ck");
        const device::Buffer<std::uint32_t> order_buffer(*device, order, "order"),
            starts(*device, first, "first");
        const Guarded<std::uint32_t> sum(*device, lengths.size() * 3, "sum");
        device::Queue queue(*device);
        queue.add<kernels::SegmentedSum>(
            lengths.size(),
            {.ci = ci,
             .cj = cj,
             .ck = ck,
             .order = order_buffer,
             .first = starts,
             .sum = sum.slice()},
            {.origin_i = origin, .origin_j = origin, .origin_k = origin});
        queue.run();
        std::vector<std::uint32_t> want;
        for (std::size_t s = 0; s < lengths.size(); ++s) {
            for (const auto& a : axis)
                want.push_back(oracle::segment_sum(a, order, first[s], first[s + 1], origin));
        }
        EXPECT_TRUE(same(sum.download(), want));
        EXPECT_TRUE(sum.untouched());
    }
};
TOPPLE_ON_EACH_FORM(SegmentedSum);

TEST_P(SegmentedSum, MatchesTheOracle) {
    for (const std::vector<std::uint32_t>& lengths : std::vector<std::vector<std::uint32_t>>{
             {}, {0}, {1}, {63}, {64}, {65}, {997}, {0, 1, 63, 64, 65, 2047, 2048, 0, 7}}) {
        SCOPED_TRACE(lengths.size());
        check(lengths, -1000, 5000);
    }
    check(std::vector<std::uint32_t>(1009, 37), 12, 600);
}

TEST_P(SegmentedSum, LongestSegmentOfTheWidestSceneFits) {
    check({2048, 2048}, -(1 << 20), 1u << 21);
}

}  // namespace
}  // namespace topple::test
