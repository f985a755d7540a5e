// SPDX-License-Identifier: MIT
#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "divide.hpp"
#include "gather.hpp"
#include "multiply_add.hpp"
#include "oracle/arithmetic_oracle.h"
#include "triad.hpp"

// The kernels that measure a device: its arithmetic and its memory.
namespace topple::test {
namespace {

class Arithmetic : public EachBackend {
  protected:
    // `check` is given counts of elements, multiples of those that one work-item holds, and of
    // rounds.
    template <class Kernel, class Check>
    void at_all_sizes(std::uint32_t many_rounds, const Check& check) const {
        const std::uint32_t items = device->items_per_lane(Kernel::source());
        for (const std::uint32_t lanes : {0u, 1u, 63u, 64u, 65u, 101u}) {
            for (const std::uint32_t rounds : {0u, 1u, many_rounds}) {
                SCOPED_TRACE(testing::Message() << lanes << " work-items, " << rounds << " rounds");
                check(lanes * items, rounds);
            }
        }
    }
    template <class Kernel, class Oracle>
    void expect_in_place(std::uint32_t many_rounds, float low, float high,
                         const Oracle& oracle) const {
        at_all_sizes<Kernel>(many_rounds, [&](std::uint32_t count, std::uint32_t rounds) {
            const std::vector<float> x = Random(count).floats(count, low, high);
            Guarded<float> array(*device, count, "x");
            array.upload(x);
            device::Queue queue(*device);
            queue.add<Kernel>(count, {.x = array.slice()}, {.count = count, .rounds = rounds});
            queue.run();
            std::vector<double> want, bound;
            oracle(x, rounds, want, bound);
            EXPECT_TRUE(within(array.download(), want, bound));
            EXPECT_TRUE(array.untouched());
        });
    }
};
TOPPLE_ON_EACH_FORM(Arithmetic);

TEST_P(Arithmetic, MultiplyAddMatchesTheOracle) {
    expect_in_place<kernels::MultiplyAdd>(1000, -600, 600, oracle::multiply_add);
}

TEST_P(Arithmetic, DivideMatchesTheOracle) {
    expect_in_place<kernels::Divide>(333, 0.01f, 50, oracle::divide);
}

TEST_P(Arithmetic, GatherMatchesTheOracle) {
    const std::uint32_t shift = 25;
    std::vector<std::uint32_t> table(1u << (32 - shift));
    Random random(3);
    for (std::uint32_t& word : table) word = random.word();
    const device::Buffer<std::uint32_t> words(*device, table, "table");
    at_all_sizes<kernels::Gather>(77, [&](std::uint32_t count, std::uint32_t rounds) {
        const Guarded<std::uint32_t> sum(*device, count, "sum");
        device::Queue queue(*device);
        queue.add<kernels::Gather>(count, {.table = words, .sum = sum.slice()},
                                   {.count = count, .rounds = rounds, .shift = shift});
        queue.run();
        EXPECT_EQ(sum.download(), oracle::gather(table, count, rounds));
        EXPECT_TRUE(sum.untouched());
    });
}

TEST_P(Arithmetic, TriadMatchesTheOracle) {
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
