// SPDX-License-Identifier: MIT
#include <thread>

#include "bounds_probe.hpp"
#include "environment.h"
#include "errors.h"
#include "multiply_add.hpp"
#include "topple/embed.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernels/queue.h"
#include "triad.hpp"

// Batches in flight: their order, what waits for them, and how they fail.
namespace topple::test {
namespace {

using ::testing::HasSubstr;

class DeviceEvent : public EachBackend {
  protected:
    using Floats = device::Buffer<float>;
    static constexpr std::uint32_t count = 1000;

    Floats of(float value, std::uint32_t size = count) const {
        return {*device, std::vector<float>(size, value), "floats"};
    }
    // to = a + scale * b
    static void add(device::Queue& queue, const Floats& a, const Floats& b, const Floats& to,
                    float scale) {
        queue.add<kernels::Triad>(a.size(), {.a = a, .b = b, .dst = to},
                                  {.count = static_cast<std::uint32_t>(a.size()), .scale = scale});
    }
    // Takes tens of milliseconds.
    device::Event submit_long(const Floats& x) const {
        device::Queue queue(*device);
        const auto size = static_cast<std::uint32_t>(x.size());
        queue.add<kernels::MultiplyAdd>(size, {.x = x}, {.count = size, .rounds = 20'000});
        return queue.submit();
    }
    std::uint64_t waits() const { return device->counters().waits; }
};
TOPPLE_ON_EACH_FORM(DeviceEvent);

TEST_P(DeviceEvent, OfNothingIsDone) {
    EXPECT_TRUE(device::Event().done());
    device::Event().wait();
    device::Queue queue(*device);
    EXPECT_TRUE(queue.submit().done());
    EXPECT_EQ(waits(), 0u);
}

// A thousand batches from two queues in turn, each from what the one before has written; behind a
// long one, so that most are in flight at the same time.
TEST_P(DeviceEvent, BatchesRunInOrderWhicheverTheirQueue) {
    const Floats busy = of(1, 1 << 16), ones = of(1), sums[] = {of(0), of(0)};
    device::Queue queues[] = {device::Queue(*device), device::Queue(*device)};
    submit_long(busy);
    device::Event last;
    for (int i = 0; i < 1000; ++i) {
        add(queues[i % 2], sums[i % 2], ones, sums[(i + 1) % 2], 1);
        last = queues[i % 2].submit();
    }
    EXPECT_EQ(waits(), 0u);
    last.wait();
    EXPECT_TRUE(last.done());
    EXPECT_EQ(waits(), 1u);
    EXPECT_TRUE(same(sums[0].download(), std::vector<float>(count, 1000)));
    EXPECT_TRUE(same(sums[1].download(), std::vector<float>(count, 999)));
    EXPECT_EQ(waits(), 1u);
    EXPECT_EQ(device->counters().submits, 1001u);
}

TEST_P(DeviceEvent, DoneComesWithoutAWait) {
    const Floats busy = of(1, 1 << 16);
    const device::Event event = submit_long(busy);
    while (!event.done()) std::this_thread::yield();
    EXPECT_EQ(waits(), 0u);
}

// The same bits as run().
TEST_P(DeviceEvent, ComputesWhatRunDoes) {
    Random random(1);
    const Floats a(*device, random.floats(count, -4, 4), "a"),
        b(*device, random.floats(count, -4, 4), "b"), run = of(0), submitted = of(0);
    device::Queue queue(*device);
    add(queue, a, b, run, 0.3f);
    queue.run();
    add(queue, a, b, submitted, 0.3f);
    queue.submit();
    EXPECT_TRUE(same(submitted.download(), run.download()));
}

// Of three batches the host waits for those alone that bind what it asks for.
TEST_P(DeviceEvent, TheHostWaitsForWhatItNeeds) {
    const Floats ones = of(1), early = of(0), late = of(1, 1 << 16);
    Floats unbound = of(3), filled = of(0);
    device::Queue queue(*device);
    add(queue, ones, ones, early, 1);
    queue.submit();
    const device::Event end = submit_long(late);
    EXPECT_EQ(unbound.download()[0], 3.0f);
    unbound.upload(std::vector<float>(count, 4));
    unbound.fill(5);
    unbound.host_view();
    EXPECT_EQ(waits(), 0u);
    EXPECT_EQ(early.download()[0], 2.0f);
    EXPECT_EQ(waits(), 1u);
    // What a batch has read may be written once it has ended, not earlier.
    add(queue, unbound, ones, filled, 1);
    queue.submit();
    unbound.fill(7);
    EXPECT_EQ(waits(), 2u);
    EXPECT_EQ(filled.download()[0], 6.0f);
    EXPECT_TRUE(end.done());
    end.wait();
    EXPECT_EQ(waits(), 2u);
}

// A view taken before is the buffer after.
TEST_P(DeviceEvent, ViewsSeeWhatBatchesWrite) {
    const Floats ones = of(1), sum = of(0);
    const std::span<float> view = sum.host_view();
    device::Queue queue(*device);
    add(queue, sum, ones, sum, 1);
    queue.submit();
    add(queue, sum, ones, sum, 1);
    queue.submit().wait();
    if (!view.empty()) {
        EXPECT_EQ(view[count - 1], 2.0f);
    }
    EXPECT_EQ(sum.host_view().empty(), view.empty());
    EXPECT_EQ(sum.download()[0], 2.0f);
}

TEST_P(DeviceEvent, BuffersMayBeFreedInFlight) {
    const Floats busy = of(1, 1 << 16), sum = of(0);
    submit_long(busy);
    device::Queue queue(*device);
    for (int i = 0; i < 100; ++i) {
        const Floats some = of(static_cast<float>(i));
        add(queue, sum, some, sum, 1);
        queue.submit();
    }
    device->trim();
    EXPECT_EQ(sum.download()[0], 4950.0f);
}

// More than the device may hold for batches in flight: it waits for some by itself.
TEST_P(DeviceEvent, MemoryInFlightIsBounded) {
    const Floats sum = of(0, 1 << 20);
    device::Queue queue(*device);
    for (int i = 0; i < 100; ++i) {
        Floats some(*device, 1 << 20, "some");
        some.fill(1);
        add(queue, sum, some, sum, 1);
        queue.submit();
    }
    EXPECT_EQ(sum.download()[0], 100.0f);
}

TEST_P(DeviceEvent, ADeviceMayEndWithBatchesInFlight) {
    for (int i = 0; i < 3; ++i) {
        const auto other = device::open_form(GetParam());
        const Floats x(*other, std::vector<float>(1 << 16, 1), "x");
        device::Queue queue(*other);
        queue.add<kernels::MultiplyAdd>(1 << 16, {.x = x}, {.count = 1 << 16, .rounds = 2'000});
        queue.submit();
    }
}

// Memory that is used again is as large as asked, with guards around it.
TEST_P(DeviceEvent, ReusedMemoryIsLikeNew) {
    for (const std::uint32_t size : {1000, 1001, 1009, 900, 1000, 0, 1}) {
        const Guarded<float> guarded(*device, size, "guarded");
        guarded.download();
        const Floats a = of(2, size);
        EXPECT_EQ(a.size(), size);
        device::Queue queue(*device);
        queue.add<kernels::Triad>(size, {.a = a, .b = a, .dst = guarded.slice()},
                                  {.count = size, .scale = 1});
        queue.run();
        EXPECT_TRUE(same(guarded.download(), std::vector<float>(size, 4)));
        EXPECT_TRUE(guarded.untouched());
    }
}

class DeviceEventErrors : public DeviceEvent {
  protected:
    void SetUp() override {
        const EnvironmentVariable asked("TOPPLE_CHECK", "bounds");
        DeviceEvent::SetUp();
    }
    using Words = device::Buffer<std::uint32_t>;
    static constexpr std::uint32_t groups = 3;

    // Writes dst; outside of it by that many elements.
    device::Event submit(const Words& dst, std::int32_t outside) const {
        const Words scale(*device, std::vector<std::uint32_t>{2, 3, 4}, "scale"),
            src(*device, std::vector<std::uint32_t>(dst.size(), 1), "src"),
            counts(*device, std::vector<std::uint32_t>(groups, 0), "counts");
        device::Queue queue(*device);
        queue.add<kernels::BoundsProbe>(
            groups, {.scale = scale, .src = src, .dst = dst, .counts = counts}, {0, outside, 0, 0});
        return queue.submit();
    }
    static constexpr const char* none = "nothing was thrown";
    static constexpr const char* beyond =
        "kernel bounds_probe: work-item 191 writes dst[192], which has 192 elements";
};
TOPPLE_ON_EACH_FORM(DeviceEventErrors);

TEST_P(DeviceEventErrors, AreToldOnce) {
    const Words before(*device, 192, "before"), bad(*device, 192, "bad"),
        after(*device, 192, "after");
    submit(before, 0);
    const device::Event wrong = submit(bad, 1);
    const device::Event end = submit(after, 0);
    // What ended before it is as it was.
    EXPECT_EQ(message_of([&] { before.download(); }), none);
    EXPECT_EQ(message_of([&] { wrong.wait(); }), beyond);
    for (const device::Event& event : {wrong, end})
        EXPECT_EQ(message_of([&] { event.wait(); }), none);
    EXPECT_EQ(after.download()[0], 2u);
    // So does the host's use of a buffer, the failed batch's or a later one's.
    submit(bad, 1);
    EXPECT_EQ(message_of([&] { bad.download(); }), beyond);
    EXPECT_EQ(message_of([&] { bad.download(); }), none);
    submit(bad, 1);
    submit(after, 0);
    EXPECT_EQ(message_of([&] { after.download(); }), beyond);
    EXPECT_EQ(after.download()[191], 4u);
}

}  // namespace
}  // namespace topple::test
