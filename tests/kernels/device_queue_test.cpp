// SPDX-License-Identifier: MIT
#include "barrier_probe.hpp"
#include "device/devices.h"
#include "errors.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernels/queue.h"
#include "triad.hpp"

namespace topple::test {
namespace {

using ::testing::HasSubstr;

class DeviceQueue : public EachBackend {
  protected:
    // c = a + scale * b over whole buffers.
    static void add(device::Queue& queue, const device::Buffer<float>& a,
                    const device::Buffer<float>& b, const device::Buffer<float>& c, float scale) {
        const auto count = static_cast<std::uint32_t>(c.size());
        queue.add<kernels::Triad>(count, {.a = a, .b = b, .dst = c},
                                  {.count = count, .scale = scale});
    }
};
TOPPLE_ON_EACH_FORM(DeviceQueue);

// 5000 steps of Fibonacci's numbers modulo what a float holds, each from the two before: longer
// than one submit of any backend, and wrong as soon as one step misses another's writes.
TEST_P(DeviceQueue, LaterDispatchesSeeEarlierWrites) {
    const std::uint32_t count = 1000;
    device::Buffer<float> ring[3];
    for (auto& buffer : ring)
        buffer = device::Buffer<float>(*device, std::vector<float>(count, 1), "ring");
    device::Queue queue(*device);
    float before = 1, last = 1;
    const int steps = 5000;
    for (int i = 0; i < steps; ++i) {
        const float scale = (i % 2 == 0) ? -1.0f : 2.0f;  // keeps the numbers small and whole
        add(queue, ring[i % 3], ring[(i + 1) % 3], ring[(i + 2) % 3], scale);
        const float next = before + scale * last;
        before = last;
        last = next;
        if (std::abs(last) > 1e6f) {
            FAIL() << "the test's own numbers grow beyond what a float holds exactly";
        }
    }
    queue.run();
    EXPECT_TRUE(same(ring[(steps + 1) % 3].download(), std::vector<float>(count, last)));
    EXPECT_EQ(device->counters().dispatches, static_cast<std::uint64_t>(steps));
}

// More groups than one Vulkan command takes: 65535 is the least limit, and lavapipe's.
TEST_P(DeviceQueue, RunsMoreThan65535Groups) {
    const std::uint32_t count = 2 * 65535 * 64 + 77;
    std::vector<float> a(count), b(count, 2.0f), want(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        a[i] = static_cast<float>(i & 0xffff);
        want[i] = a[i] + 6.0f;
    }
    const device::Buffer<float> in_a(*device, a, "a"), in_b(*device, b, "b");
    const Guarded<float> out(*device, count, "dst");
    run_kernel<kernels::Triad>(*device, count, {.a = in_a, .b = in_b, .dst = out.slice()},
                               {.count = count, .scale = 3});
    EXPECT_TRUE(same(out.download(), want));
    EXPECT_TRUE(out.untouched());
}

TEST_P(DeviceQueue, BindsSlices) {
    const std::uint64_t step = device::slice_alignment / 4;
    std::vector<float> data(4 * step);
    std::iota(data.begin(), data.end(), 0.0f);
    device::Buffer<float> buffer(*device, data, "quarters");
    device::Queue queue(*device);
    const auto count = static_cast<std::uint32_t>(step);
    queue.add<kernels::Triad>(count,
                              {.a = buffer.slice(0, step),
                               .b = buffer.slice(step, step),
                               .dst = buffer.slice(3 * step, step)},
                              {.count = count, .scale = 10});
    queue.run();
    for (std::uint64_t i = 0; i < step; ++i)
        data[3 * step + i] = static_cast<float>(i) + 10 * static_cast<float>(step + i);
    EXPECT_TRUE(same(buffer.download(), data));
}

// A view taken before a run is still the buffer after it.
TEST_P(DeviceQueue, HostViewSeesWhatKernelsWrite) {
    const device::Buffer<float> a(*device, std::vector<float>(100, 1), "a"),
        b(*device, std::vector<float>(100, 2), "b");
    device::Buffer<float> c(*device, 100, "c");
    c.fill(0);
    const std::span<float> view = c.host_view();
    for (const float scale : {3.0f, 4.0f}) {
        device::Queue queue(*device);
        add(queue, a, b, c, scale);
        queue.run();
        EXPECT_TRUE(same(c.download(), std::vector<float>(100, 1 + 2 * scale)));
        if (!view.empty()) {
            EXPECT_TRUE(same(std::vector<float>(view.begin(), view.end()),
                             std::vector<float>(100, 1 + 2 * scale)));
        }
    }
}

TEST_P(DeviceQueue, RunsNothingWhenNothingWasAdded) {
    const device::Buffer<float> none(*device, 0, "none");
    device::Queue queue(*device);
    queue.run();
    queue.add<kernels::Triad>(0, {.a = none, .b = none, .dst = none}, {.count = 0, .scale = 1});
    queue.run();
    EXPECT_EQ(device->counters().submits, 0u);
    EXPECT_EQ(device->counters().dispatches, 0u);
}

// An empty array can be bound, also one at the very end of a buffer.
TEST_P(DeviceQueue, BindsEmptyArrays) {
    const std::uint64_t step = device::slice_alignment / 4;
    device::Buffer<float> buffer(*device, std::vector<float>(step, 5), "whole"),
        none(*device, 0, "none");
    run_kernel<kernels::Triad>(*device, 1, {.a = none, .b = buffer.slice(step, 0), .dst = buffer},
                               {.count = 0, .scale = 1});
    EXPECT_TRUE(same(buffer.download(), std::vector<float>(step, 5)));
    EXPECT_EQ(device->counters().dispatches, 1u);
}

TEST_P(DeviceQueue, BuildsEachKernelOnceAndWaitsOnce) {
    const device::Buffer<float> a(*device, std::vector<float>(10), "a");
    const device::Buffer<float> c(*device, 10, "c");
    device->prepare(kernels::Triad::source());
    for (int run = 0; run < 2; ++run) {
        device::Queue queue(*device);
        for (int i = 0; i < 5; ++i) add(queue, a, a, c, 1);
        queue.run();
    }
    EXPECT_EQ(device->counters().submits, 2u);
    EXPECT_EQ(device->counters().dispatches, 10u);
    EXPECT_EQ(device->counters().bytes_bound, 10u * 3 * 10 * 4);
    EXPECT_LE(device->counters().kernel_builds, 1u);
}

TEST_P(DeviceQueue, NamesWhatCannotBeBound) {
    const device::Buffer<float> a(*device, 10, "a");
    const device::Buffer<float> unset;
    device::Queue queue(*device);
    EXPECT_EQ(message_of([&] {
                  queue.add<kernels::Triad>(10, {.a = a, .b = unset, .dst = a},
                                            {.count = 10, .scale = 1});
              }),
              "kernel triad: binding b is given a Buffer that was never allocated");
    EXPECT_THAT(message_of([&] {
                    queue.add<kernels::Triad>(1ull << 33, {.a = a, .b = a, .dst = a},
                                              {.count = 10, .scale = 1});
                }),
                HasSubstr("exceed 2^32"));
}

TEST_P(DeviceQueue, RefusesBuffersOfAnotherDevice) {
    const auto other = device::open_native();
    const device::Buffer<float> a(*device, 10, "mine"), b(*other, 10, "theirs");
    device::Queue queue(*device);
    add(queue, a, b, a, 1);
    EXPECT_THAT(message_of([&] { queue.run(); }),
                HasSubstr("buffer theirs belongs to another device"));
    // The refused batch is gone.
    add(queue, a, a, a, 1);
    EXPECT_NO_THROW(queue.run());
}

// Barriers, shared memory and atomics, against a plain loop.
TEST_P(DeviceQueue, GroupsWorkTogether) {
    for (const std::size_t count : {1, 63, 64, 65, 997, 100'003}) {
        SCOPED_TRACE(count);
        Random random(count);
        std::vector<std::uint32_t> src(count);
        for (auto& v : src) v = random.word();
        const std::size_t groups = (count + 63) / 64;
        std::vector<std::uint32_t> want_sums(groups, 0), want_counts(8, 0);
        for (std::size_t i = 0; i < count; ++i) {
            want_sums[i / 64] += src[i];
            ++want_counts[src[i] % 8];
        }
        const auto [low, high] = std::minmax_element(src.begin(), src.end());

        const device::Buffer<std::uint32_t> in(*device, src, "src");
        const Guarded<std::uint32_t> sums(*device, groups, "sums");
        const device::Buffer<std::uint32_t> counts(*device, std::vector<std::uint32_t>(8, 0),
                                                   "counts");
        const device::Buffer<std::uint32_t> extremes(
            *device, std::vector<std::uint32_t>{0xffffffffu, 0}, "extremes");
        run_kernel<kernels::BarrierProbe>(
            *device, groups,
            {.src = in, .sums = sums.slice(), .counts = counts, .extremes = extremes},
            {.count = static_cast<std::uint32_t>(count)});
        EXPECT_TRUE(same(sums.download(), want_sums));
        EXPECT_TRUE(same(counts.download(), want_counts));
        EXPECT_TRUE(same(extremes.download(), {*low, *high}));
        EXPECT_TRUE(sums.untouched());
    }
}

}  // namespace
}  // namespace topple::test
