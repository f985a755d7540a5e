// SPDX-License-Identifier: MIT
#include <cstdlib>

#include "barrier_probe.hpp"
#include "device/queue.h"
#include "device/vulkan/vulkan_device.h"
#include "device_compare.h"
#include "device_harness.h"
#include "triad.hpp"

// The Vulkan backend's paths that only other drivers take: memory that the host can't see, few
// groups in a command, few dispatches in a submit; and all of it under the validation layers.
namespace topple::test {
namespace {

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

}  // namespace
}  // namespace topple::test
