// SPDX-License-Identifier: MIT
#include <CL/cl.h>
#include <vulkan/vulkan.h>

#include <chrono>
#include <thread>

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "topple/embed.h"
#include "triad.hpp"

// Running on handles that the caller made, keeps and destroys.
namespace topple::test {
namespace {

// Runs a kernel on the device; what it gives is right.
void use(device::Device& device) {
    const std::vector<float> a{1, 2, 3}, b{10, 20, 30};
    const device::Buffer<float> in_a(device, a, "a"), in_b(device, b, "b"), out(device, 3, "dst");
    device::Queue queue(device);
    queue.add<kernels::Triad>(3, {.a = in_a, .b = in_b, .dst = out}, {.count = 3, .scale = 2});
    queue.run();
    EXPECT_EQ(out.download(), (std::vector<float>{21, 42, 63}));
}

// A missing driver skips by name, or fails where the backends are required.
class DeviceAdopt : public ::testing::Test {
  protected:
    bool missing(const char* what) {
        const char* required = std::getenv("TOPPLE_REQUIRE_BACKENDS");
        EXPECT_FALSE(required && std::string(required) == "1") << what << " is missing";
        return true;
    }
};

TEST_F(DeviceAdopt, OpenClHandlesStayTheCallers) {
    cl_platform_id platform = nullptr;
    cl_device_id id = nullptr;
    if ((clGetPlatformIDs(1, &platform, nullptr) != CL_SUCCESS ||
         clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &id, nullptr) != CL_SUCCESS) &&
        missing("an OpenCL driver")) {
        GTEST_SKIP() << "no OpenCL driver";
    }
    cl_int code = CL_SUCCESS;
    cl_context context = clCreateContext(nullptr, 1, &id, nullptr, nullptr, &code);
    ASSERT_EQ(code, CL_SUCCESS);
    cl_command_queue queue = clCreateCommandQueue(context, id, 0, &code);
    ASSERT_EQ(code, CL_SUCCESS);
    for (int life = 0; life < 2; ++life) {
        const auto device = device::adopt_opencl({context, id, queue});
        EXPECT_EQ(device->info().backend, device::Backend::opencl);
        use(*device);
    }
    // The adopted device is gone; the handles still work, and nobody else holds them.
    EXPECT_EQ(clFinish(queue), CL_SUCCESS);
    // PoCL's worker lets go of the last event, and with it of the queue, a little after clFinish.
    cl_uint references = 0;
    for (int wait = 0; wait < 1000 && references != 1; ++wait) {
        if (wait > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        ASSERT_EQ(clGetCommandQueueInfo(queue, CL_QUEUE_REFERENCE_COUNT, sizeof(references),
                                        &references, nullptr),
                  CL_SUCCESS);
    }
    EXPECT_EQ(references, 1u);
    clReleaseCommandQueue(queue);
    clReleaseContext(context);
}

TEST_F(DeviceAdopt, VulkanHandlesStayTheCallers) {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_1;
    VkInstanceCreateInfo instance_info{};
    instance_info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    instance_info.pApplicationInfo = &application;
    VkInstance instance = VK_NULL_HANDLE;
    std::uint32_t count = 0;
    if ((vkCreateInstance(&instance_info, nullptr, &instance) != VK_SUCCESS ||
         vkEnumeratePhysicalDevices(instance, &count, nullptr) != VK_SUCCESS || count == 0) &&
        missing("a Vulkan driver")) {
        GTEST_SKIP() << "no Vulkan driver";
    }
    std::vector<VkPhysicalDevice> devices(count);
    ASSERT_EQ(vkEnumeratePhysicalDevices(instance, &count, devices.data()), VK_SUCCESS);
    VkQueueFamilyProperties families[8];
    std::uint32_t family_count = 8, family = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(devices[0], &family_count, families);
    while (family < family_count && !(families[family].queueFlags & VK_QUEUE_COMPUTE_BIT)) ++family;
    ASSERT_LT(family, family_count);
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info{};
    queue_info.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue_info.queueFamilyIndex = family;
    queue_info.queueCount = 1;
    queue_info.pQueuePriorities = &priority;
    VkDeviceCreateInfo device_info{};
    device_info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    device_info.queueCreateInfoCount = 1;
    device_info.pQueueCreateInfos = &queue_info;
    VkDevice handle = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDevice(devices[0], &device_info, nullptr, &handle), VK_SUCCESS);
    VkQueue queue = VK_NULL_HANDLE;
    vkGetDeviceQueue(handle, family, 0, &queue);
    for (int life = 0; life < 2; ++life) {
        const auto device = device::adopt_vulkan({instance, devices[0], handle, queue, family});
        EXPECT_EQ(device->info().backend, device::Backend::vulkan);
        use(*device);
    }
    EXPECT_THROW(device::adopt_vulkan({instance, devices[0], handle, queue, family_count}), Error);
    EXPECT_EQ(vkDeviceWaitIdle(handle), VK_SUCCESS);
    vkDestroyDevice(handle, nullptr);
    vkDestroyInstance(instance, nullptr);
}

TEST_F(DeviceAdopt, RefusesNullHandles) {
    EXPECT_THROW(device::adopt_opencl({}), Error);
    EXPECT_THROW(device::adopt_vulkan({}), Error);
}

}  // namespace
}  // namespace topple::test
