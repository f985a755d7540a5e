// SPDX-License-Identifier: MIT
#include "device/bounds_check.h"

#include "bounds_probe.hpp"
#include "environment.h"
#include "errors.h"
#include "topple/embed.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernels/queue.h"

// TOPPLE_CHECK=bounds: what it says of accesses outside of what is bound.
namespace topple::test {
namespace {

class BoundsCheck : public EachBackend {
  protected:
    using Words = device::Buffer<std::uint32_t>;
    void SetUp() override {
        const EnvironmentVariable asked("TOPPLE_CHECK", "bounds");
        EachBackend::SetUp();
    }
    static constexpr std::uint32_t groups = 3, count = groups * 64;

    // One batch: a dispatch in order, then one with these parameters and that many elements of src.
    std::string said_of(const kernels::BoundsProbeParams& params, std::uint32_t src_count = count) {
        const Words scale(*device, std::vector<std::uint32_t>{2, 3, 4}, "scale");
        const Words src(*device, std::vector<std::uint32_t>(count, 1), "src");
        const Guarded<std::uint32_t> dst(*device, count, "dst");
        const Words counts(*device, std::vector<std::uint32_t>(groups, 0), "counts");
        device::Queue queue(*device);
        const auto add = [&](const kernels::BoundsProbeParams& p, std::uint32_t of_src) {
            queue.add<kernels::BoundsProbe>(
                groups,
                {.scale = scale, .src = src.slice(0, of_src), .dst = dst.slice(), .counts = counts},
                p);
        };
        add({}, count);
        add(params, src_count);
        const std::string said = message_of([&] { queue.run(); });
        EXPECT_TRUE(dst.untouched());
        return said;
    }
    static std::string access(const std::string& who, const std::string& what, std::uint64_t of) {
        return "kernel bounds_probe: " + who + " " + what + ", which has " + std::to_string(of) +
               (of == 1 ? " element" : " elements");
    }
};
TOPPLE_ON_EACH_FORM(BoundsCheck);

TEST_P(BoundsCheck, LetsPassWhatIsInside) {
    EXPECT_EQ(said_of({}), "nothing was thrown");
}

// One step too far in what is read, written, added to and read by a group: one work-item is
// outside.
TEST_P(BoundsCheck, NamesTheAccess) {
    EXPECT_EQ(said_of({1, 0, 0, 0}), access("work-item 191", "reads src[192]", 192));
    EXPECT_EQ(said_of({0, 1, 0, 0}), access("work-item 191", "writes dst[192]", 192));
    EXPECT_EQ(said_of({0, -1, 0, 0}), access("work-item 0", "writes dst[-1]", 192));
    EXPECT_EQ(said_of({0, 0, 1, 0}), access("work-item 128", "writes counts[3]", 3));
    EXPECT_EQ(said_of({0, 0, 0, 1}), access("work-group 2", "reads scale[3]", 3));
}

TEST_P(BoundsCheck, KnowsTheRangeOfASlice) {
    EXPECT_EQ(said_of({}, count - 1), access("work-item 191", "reads src[191]", 191));
    // Of none it is any work-item.
    const std::string said = said_of({}, 0);
    EXPECT_THAT(said, ::testing::HasSubstr(" reads src["));
    EXPECT_THAT(said, ::testing::EndsWith("which has 0 elements"));
}

// The results are those of the form that does not check.
TEST_P(BoundsCheck, ComputesTheSame) {
    std::vector<std::uint32_t> data(count), want(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        data[i] = i * i + 7;
        want[i] = data[i] * (2 + i / 64);
    }
    const Words scale(*device, std::vector<std::uint32_t>{2, 3, 4}, "scale"),
        src(*device, data, "src"), dst(*device, count, "dst"),
        counts(*device, std::vector<std::uint32_t>(groups, 0), "counts");
    run_kernel<kernels::BoundsProbe>(
        *device, groups, {.scale = scale, .src = src, .dst = dst, .counts = counts}, {});
    EXPECT_TRUE(same(dst.download(), want));
    EXPECT_TRUE(same(counts.download(), std::vector<std::uint32_t>(groups, 64)));
}

TEST_P(BoundsCheck, RefusesAKernelWithoutACheckedForm) {
    device::KernelSource unchecked = kernels::BoundsProbe::source();
    unchecked.checked = nullptr;
    std::vector<device::Dispatch> batch(1);
    batch[0].kernel = &unchecked;
    EXPECT_EQ(message_of([&] { device::BoundsCheck(*device, batch); }),
              "TOPPLE_CHECK=bounds: kernel bounds_probe was built without its checked form; "
              "configure the build with -DTOPPLE_CHECKED_KERNELS=ON");
}

TEST(BoundsCheckAsked, ForSomethingElse) {
    const EnvironmentVariable asked("TOPPLE_CHECK", "everything");
    EXPECT_EQ(message_of([] { device::open_device("native"); }, ErrorKind::usage),
              "TOPPLE_CHECK=everything is unknown; take bounds");
}

}  // namespace
}  // namespace topple::test
