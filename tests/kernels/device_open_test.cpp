// SPDX-License-Identifier: MIT
#include <thread>

#include "barrier_probe.hpp"
#include "device/vulkan/vulkan_device.h"
#include "dialect_probe.hpp"
#include "errors.h"
#include "oracle/arithmetic_oracle.h"
#include "support_function.hpp"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernels/queue.h"
#include "triad.hpp"

namespace topple::test {
namespace {

TEST(DeviceOpen, RefusesUnknownBackends) {
    for (const char* name : {"cuda", "", "Native", "opencl "}) {
        EXPECT_THAT(message_of([&] { device::open_device(name); }, ErrorKind::usage),
                    ::testing::HasSubstr("auto, native, opencl or vulkan"));
    }
}

TEST(DeviceOpen, ListsEveryBackendInOrder) {
    const std::vector<device::Listing> all = device::list_devices();
    ASSERT_FALSE(all.empty());
    bool seen[3] = {};
    for (std::size_t i = 0; i < all.size(); ++i) {
        seen[static_cast<int>(all[i].backend)] = true;
        if (i > 0) {
            EXPECT_LE(all[i - 1].backend, all[i].backend);
        }
        EXPECT_EQ(all[i].usable, all[i].problem.empty());
        if (!all[i].usable) continue;
        const device::DeviceInfo& info = all[i].info;
        EXPECT_EQ(info.backend, all[i].backend);
        EXPECT_FALSE(info.name.empty());
        EXPECT_FALSE(info.driver.empty());
        EXPECT_GE(info.limits.max_binding_bytes, 128u << 20) << info.name;
        EXPECT_GE(info.limits.max_allocation_bytes, info.limits.max_binding_bytes) << info.name;
        EXPECT_GE(info.limits.max_group_size, 64u) << info.name;
    }
    EXPECT_TRUE(seen[0] && seen[1] && seen[2]);
    EXPECT_TRUE(all[0].usable);
}

// Drivers are less sure of that than their specifications.
TEST(DeviceOpen, OpenClFromEightThreadsAtOnce) {
    std::vector<std::jthread> threads;
    std::vector<std::string> found(8);
    for (std::string& mine : found) {
        threads.emplace_back([&mine] {
            for (int repeat = 0; repeat < 4; ++repeat) {
                mine.clear();
                bool usable = false;
                for (const auto& listing : device::list_devices()) {
                    mine += listing.info.name + listing.problem + "\n";
                    usable |= listing.usable && listing.info.backend == device::Backend::opencl;
                }
                if (usable) device::open_device("opencl");
            }
        });
    }
    threads.clear();
    for (const std::string& one : found) EXPECT_EQ(one, found.front());
    EXPECT_FALSE(found.front().empty());
}

// A CPU behind a GPU's interface never beats the native backend.
TEST(DeviceOpen, AutoTakesAGpuOrElseTheNativeBackend) {
    bool gpu = false;
    for (const auto& listing : device::list_devices()) gpu |= listing.usable && listing.info.gpu;
    const auto device = device::open_device("auto");
    EXPECT_EQ(device->info().gpu, gpu);
    EXPECT_EQ(device->info().backend == device::Backend::native, !gpu);
}

class DeviceOpenEach : public EachBackend {};
TOPPLE_ON_EACH_BACKEND(DeviceOpenEach);

TEST_P(DeviceOpenEach, IsAmongTheListed) {
    bool found = false;
    for (const auto& listing : device::list_devices()) {
        found |= listing.usable && listing.info.backend == device->info().backend &&
                 listing.info.name == device->info().name;
    }
    EXPECT_TRUE(found) << device->info().name;
}

// Two devices of one backend live side by side.
TEST_P(DeviceOpenEach, OpensTwice) {
    const auto other = device::open_form(GetParam());
    device::Buffer<float> a(*device, std::vector<float>{1, 2}, "a"),
        b(*other, std::vector<float>{3, 4}, "b");
    EXPECT_EQ(a.download(), (std::vector<float>{1, 2}));
    EXPECT_EQ(b.download(), (std::vector<float>{3, 4}));
}

std::vector<float> supports(device::Device& device) {
    Random random(5);
    const std::uint32_t vertices = 101, directions = 32 * 997;
    std::vector<device::Buffer<float>> arrays;
    for (const std::uint32_t count :
         {vertices, vertices, vertices, directions, directions, directions}) {
        arrays.emplace_back(device, random.floats(count, -1, 1), "coordinates");
    }
    const device::Buffer<float> s(device, directions, "s");
    run_kernel<kernels::SupportFunction>(
        device, directions, {arrays[0], arrays[1], arrays[2], arrays[3], arrays[4], arrays[5], s},
        {.vertex_count = vertices,
         .vertex_first = 0,
         .direction_count = directions,
         .output_first = 0});
    return s.download();
}

TEST(DeviceOpen, NativeGivesTheSameOnAnyNumberOfThreads) {
    const auto one = device::open_device("native", 1);
    EXPECT_EQ(one->info().driver, "1 threads");
    const std::vector<float> want = supports(*one);
    for (const unsigned threads : {2u, 3u, 8u}) {
        EXPECT_TRUE(same(supports(*device::open_device("native", threads)), want))
            << threads << " threads";
    }
}

// The Vulkan backend's paths that only other drivers take: memory that the host can't see, few
// groups in a command, few dispatches in a submit; and all of it under the validation layers.

struct Environment {  // sets a variable for one test
    explicit Environment(const char* variable) : name(variable) {
        const char* before = std::getenv(name);
        if (before) old = before;
        had = before != nullptr;
        setenv(name, "1", 1);
    }
    ~Environment() { had ? setenv(name, old.c_str(), 1) : unsetenv(name); }
    const char* name;
    std::string old;
    bool had = false;
};

class DeviceVulkan : public ::testing::Test {
  protected:
    std::unique_ptr<device::VulkanDevice> open(const device::VulkanOptions& options) {
        try {
            return std::make_unique<device::VulkanDevice>(device::open_vulkan_context(), options);
        } catch (const Error& error) {
            // The package vulkan-validationlayers is not asked for.
            if (std::string(error.what()).starts_with("TOPPLE_VULKAN_VALIDATION")) return nullptr;
            EXPECT_FALSE(backends_required()) << error.what();
            return nullptr;
        }
    }
    // Upload, fill, a chain of dispatches, groups with barriers, download: all that a device does.
    static void exercise(device::Device& device) {
        const std::uint32_t count = 10'007;
        std::vector<float> a(count), want(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            a[i] = static_cast<float>(i);
            want[i] = a[i] + 200;
        }
        const device::Buffer<float> in(device, a, "in");
        device::Buffer<float> two(device, count, "two"), sum(device, count, "sum"),
            other(device, count, "other");
        two.fill(2);
        sum.upload(a);
        device::Queue queue(device);
        for (int i = 0; i < 100; ++i) {
            const auto& from = i % 2 == 0 ? sum : other;
            const auto& to = i % 2 == 0 ? other : sum;
            queue.add<kernels::Triad>(count, {.a = from, .b = two, .dst = to},
                                      {.count = count, .scale = 1});
        }
        queue.run();
        EXPECT_TRUE(same(sum.download(), want));

        std::vector<std::uint32_t> ones(count, 1), sums(count / 64 + 1, 64);
        sums.back() = count % 64;
        const device::Buffer<std::uint32_t> src(device, ones, "src"),
            got(device, sums.size(), "sums"),
            bins(device, std::vector<std::uint32_t>(8, 0), "bins"),
            extremes(device, std::vector<std::uint32_t>{~0u, 0}, "extremes");
        queue.add<kernels::BarrierProbe>(
            sums.size(), {.src = src, .sums = got, .counts = bins, .extremes = extremes},
            {.count = count});
        queue.run();
        EXPECT_TRUE(same(got.download(), sums));
        EXPECT_EQ(bins.download()[1], count);
    }
};

TEST_F(DeviceVulkan, CopiesThroughAStagingBuffer) {
    // Smaller than the arrays, and no divisor of their size.
    const auto device = open({.force_staging = true, .staging_bytes = 4096 - 256});
    if (!device) GTEST_SKIP() << "no Vulkan driver";
    exercise(*device);
    const device::Buffer<float> buffer(*device, 10, "unseen");
    EXPECT_TRUE(buffer.host_view().empty());
}

TEST_F(DeviceVulkan, SplitsWideDispatchesAndLongBatches) {
    const auto device = open({.max_groups = 7, .dispatches_per_submit = 3});
    if (!device) GTEST_SKIP() << "no Vulkan driver";
    exercise(*device);
    EXPECT_EQ(device->counters().submits, 34u + 1u);
    EXPECT_EQ(device->counters().dispatches, 101u);
}

TEST_F(DeviceVulkan, PassesTheValidationLayers) {
    const Environment on("TOPPLE_VULKAN_VALIDATION");
    const auto device =
        open({.force_staging = true, .max_groups = 100, .dispatches_per_submit = 60});
    if (!device) GTEST_SKIP() << "no Vulkan driver, or vulkan-validationlayers is not installed";
    EXPECT_TRUE(device->validates());
    exercise(*device);
}

// The layers are really on: what breaks a rule throws, with their words.
TEST_F(DeviceVulkan, ValidationErrorsThrow) {
    const Environment on("TOPPLE_VULKAN_VALIDATION");
    const auto device = open({});
    if (!device) GTEST_SKIP() << "no Vulkan driver, or vulkan-validationlayers is not installed";
    EXPECT_TRUE(device->validates());
    device::KernelSource wrong = kernels::Triad::source();
    wrong.name = "wrong";
    wrong.bindings = wrong.bindings.first(2);  // the shader uses a third
    EXPECT_THAT(message_of([&] { device->prepare(wrong); }),
                ::testing::HasSubstr("kernel wrong: Vulkan validation: "));
}

// What docs/dialect.md promises of arithmetic: the same bits on every backend, and IEEE 754's.

struct Numbers {
    std::vector<float> a, b;
    std::vector<std::uint32_t> m, n;
};

// All pairs of special numbers, then random bit patterns.
Numbers numbers() {
    const float inf = std::numeric_limits<float>::infinity();
    const float special[] = {0.0f, -0.0f, 1.0f, -1.0f, 1e-40f, -1e-40f, 3.4e38f, -3.4e38f, 0.5f,
                             -2.5f, 1.5e-38f, inf, -inf, 8388609.f, 0.1f, -0.3f,
                             // Between two halves, and at the ends of what they reach.
                             65519.0f, 65520.0f, 0x1p-25f, -0x3p-25f, 0x801p-11f, -0x803p-11f};
    const std::uint32_t words[] = {0, 1, 31, 32, 0x7fffffff, 0x80000000, 0xffffffff, 12345};
    Numbers out;
    for (const float x : special) {
        for (const float y : special) {
            out.a.push_back(x);
            out.b.push_back(y);
        }
    }
    Random random(11);
    while (out.a.size() < 100'003) {
        const auto x = std::bit_cast<float>(random.word()), y = std::bit_cast<float>(random.word());
        if (std::isnan(x) || std::isnan(y)) continue;
        out.a.push_back(x);
        out.b.push_back(y);
    }
    for (std::size_t i = 0; i < out.a.size(); ++i) {
        out.m.push_back(i < 64 ? words[i / 8] : random.word());
        out.n.push_back(i < 64 ? words[i % 8] : random.word());
    }
    return out;
}

// The sum, difference, product or quotient of two floats is exact enough in double precision that
// rounding it once more to float gives the float operation's result (Figueroa 1995).
std::vector<float> expected_floats(const Numbers& in) {
    std::vector<float> out;
    for (std::size_t i = 0; i < in.a.size(); ++i) {
        const double x = in.a[i], y = in.b[i];
        const auto product = static_cast<float>(x * y), sum = static_cast<float>(x + y);
        out.insert(out.end(),
                   {sum, static_cast<float>(x - y), product, static_cast<float>(x / y),
                    static_cast<float>(double{product} + x), static_cast<float>(double{sum} - x),
                    static_cast<float>(std::sqrt(std::abs(x))), static_cast<float>(std::floor(x)),
                    y < x ? in.b[i] : in.a[i], x < y ? in.b[i] : in.a[i]});
    }
    return out;
}

std::vector<std::uint32_t> expected_words(const Numbers& in) {
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < in.m.size(); ++i) {
        const std::uint32_t u = in.m[i], v = in.n[i];
        const auto clamped = static_cast<std::int32_t>(-std::min<std::int64_t>(u & 0xffff, 1000));
        out.insert(out.end(),
                   {bits(in.a[i]), u + v, u * v, u / (v / 2 + 1), (u >> v % 32) ^ (u << v % 32),
                    static_cast<std::uint32_t>(clamped) + (v & 0xffff),
                    static_cast<std::uint32_t>(std::uint64_t{u} * v >> 32),
                    static_cast<std::uint32_t>(std::popcount(u)), oracle::half_bits(in.a[i]),
                    bits(oracle::of_half_bits(v & 0xffff))});
    }
    return out;
}

bool denormal(float v) {
    return std::fpclassify(v) == FP_SUBNORMAL;
}

// Vulkan drivers of real GPUs may take denormals for zeros, where they don't promise to keep them.
// All else is IEEE 754's: only results of denormals, and denormal ones, are taken from `want`.
std::vector<float> but_for_denormals(std::vector<float> got, const std::vector<float>& want,
                                     const Numbers& in) {
    const std::size_t each = want.size() / in.a.size();
    for (std::size_t i = 0; i < got.size(); ++i) {
        const std::size_t n = i / each;
        const float sum = in.a[n] + in.b[n], product = in.a[n] * in.b[n];
        if (denormal(in.a[n]) || denormal(in.b[n]) || denormal(want[i]) || denormal(sum) ||
            denormal(product)) {
            got[i] = want[i];
        }
    }
    return got;
}

class DeviceDialect : public EachBackend {};
TOPPLE_ON_EACH_FORM(DeviceDialect);

TEST_P(DeviceDialect, RoundsAsIeee754OnEveryBackend) {
    const Numbers in = numbers();
    const auto count = static_cast<std::uint32_t>(in.a.size());
    const device::Buffer<float> a(*device, in.a, "a"), b(*device, in.b, "b");
    const device::Buffer<std::uint32_t> m(*device, in.m, "m"), n(*device, in.n, "n");
    const Guarded<float> f(*device, 10ull * count, "f");
    const Guarded<std::uint32_t> w(*device, 10ull * count, "w");
    Guarded<std::uint32_t> line(*device, count, "line");
    line.upload(std::vector<std::uint32_t>(count, 7));
    run_kernel<kernels::DialectProbe>(
        *device, count,
        {.a = a, .b = b, .m = m, .n = n, .f = f.slice(), .w = w.slice(), .line = line.slice()},
        {.count = count});
    std::vector<std::uint32_t> lines = in.m;
    std::fill(lines.begin() + count / 16 * 16, lines.end(), 7);
    const std::vector<float> want = expected_floats(in);
    std::vector<float> got = f.download();
    if (device->info().gpu && device->info().backend == device::Backend::vulkan)
        got = but_for_denormals(std::move(got), want, in);
    EXPECT_TRUE(same(got, want));
    EXPECT_TRUE(same(w.download(), expected_words(in)));
    EXPECT_TRUE(f.untouched());
    EXPECT_TRUE(w.untouched());
    EXPECT_TRUE(same(line.download(), lines));
    EXPECT_TRUE(line.untouched());
}

}  // namespace
}  // namespace topple::test
