// SPDX-License-Identifier: MIT
#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "triad.hpp"

// Kernels that can't be built say so by name, with the driver's own words.
namespace topple::test {
namespace {

using ::testing::HasSubstr;

std::string build_error(device::Device& device, const device::KernelSource& source) {
    return message_of([&] { device.prepare(source); });
}

// OpenCL kernels are compiled at first use; the others with topple, and only set up by the driver.
class OpenClErrors : public EachBackend {};
INSTANTIATE_TEST_SUITE_P(Device, OpenClErrors, ::testing::Values("opencl"), backend_name);
class VulkanErrors : public EachBackend {};
INSTANTIATE_TEST_SUITE_P(Device, VulkanErrors, ::testing::Values("vulkan"), backend_name);

TEST_P(OpenClErrors, BuildLogNamesFileAndLine) {
    device::KernelSource broken = kernels::Triad::source();
    broken.name = "broken";
    broken.opencl =
        "#line 1 \"kernels/broken.kernel\"\n"
        "__kernel void broken(__global float* x) {\n"
        "    x[0] = no_such_name;\n"
        "}\n";
    const std::string message = build_error(*device, broken);
    EXPECT_THAT(message, HasSubstr("kernel broken does not build for " + device->info().name));
    // NVIDIA's compiler counts lines of what it is given, whatever #line says.
    if (!device->info().gpu) {
        EXPECT_THAT(message, HasSubstr("broken.kernel:2"));
    }
    EXPECT_THAT(message, HasSubstr("no_such_name"));
    EXPECT_EQ(device->counters().kernel_builds, 0u);
    // The device still works.
    EXPECT_NO_THROW(device->prepare(kernels::Triad::source()));
}

TEST_P(VulkanErrors, RefusesGroupsLargerThanTheDeviceRuns) {
    device::KernelSource wide = kernels::Triad::source();
    wide.name = "wide";
    wide.group_size = device->info().limits.max_group_size + 1;
    EXPECT_THAT(build_error(*device, wide),
                HasSubstr("kernel wide does not build for " + device->info().name));
}

// A batch with a kernel that does not build runs none of its dispatches.
TEST_P(OpenClErrors, ABatchThatCannotBuildRunsNothing) {
    device::KernelSource broken = kernels::Triad::source();
    broken.name = "broken";
    broken.opencl = "not a kernel";
    const device::Buffer<float> a(*device, std::vector<float>(10, 1), "a"),
        c(*device, std::vector<float>(10, 0), "c");
    const kernels::TriadParams params{.count = 10, .scale = 1};
    device::Dispatch dispatch;
    dispatch.kernel = &kernels::Triad::source();
    dispatch.groups = 1;
    kernels::Triad::bind({.a = a, .b = a, .dst = c}, dispatch.ranges);
    const auto bytes = std::as_bytes(std::span(&params, 1));
    dispatch.params.assign(bytes.begin(), bytes.end());
    std::vector<device::Dispatch> batch{dispatch, dispatch};
    batch[1].kernel = &broken;
    EXPECT_THROW(device->run(batch), Error);
    EXPECT_TRUE(same(c.download(), std::vector<float>(10, 0)));
    batch.pop_back();
    device->run(batch);
    EXPECT_TRUE(same(c.download(), std::vector<float>(10, 2)));
}

// The range of one binding is limited; what is larger goes in tiles.
TEST_P(VulkanErrors, RefusesBindingsBeyondTheLimit) {
    const auto& limits = device->info().limits;
    if (limits.max_binding_bytes + 4 > limits.max_allocation_bytes) {
        GTEST_SKIP() << "what this device allocates it can bind";
    }
    const std::uint64_t count = limits.max_binding_bytes / 4 + 1;
    const device::Buffer<float> large(*device, count, "large");
    device::Queue queue(*device);
    EXPECT_THAT(message_of([&] {
                    queue.add<kernels::Triad>(64, {.a = large, .b = large, .dst = large},
                                              {.count = 64, .scale = 1});
                }),
                HasSubstr("kernel triad: binding a spans"));
}

}  // namespace
}  // namespace topple::test
