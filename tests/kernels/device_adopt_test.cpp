// SPDX-License-Identifier: MIT
#include <CL/cl.h>
#include <vulkan/vulkan.h>

#include <chrono>
#include <thread>

#include "device/adopted_buffer.h"
#include "errors.h"
#include "topple/embed.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernels/queue.h"
#include "triad.hpp"

// Running on handles that the caller made, keeps and destroys.
namespace topple::test {
namespace {

// Runs a kernel on the device; what it gives is right.
void use(device::Device& device) {
    const std::vector<float> a{1, 2, 3}, b{10, 20, 30};
    const device::Buffer<float> in_a(device, a, "a"), in_b(device, b, "b"), out(device, 3, "dst");
    run_kernel<kernels::Triad>(device, 3, {.a = in_a, .b = in_b, .dst = out},
                               {.count = 3, .scale = 2});
    EXPECT_EQ(out.download(), (std::vector<float>{21, 42, 63}));
}

constexpr std::uint64_t buffer_bytes = 1024;

// The same on the caller's buffers of that size: two to read, whose first values are those of
// use(), and one to write.
void use_buffers(device::Device& device, void* a, void* b, void* dst) {
    const auto in_a = device::adopt_buffer(device, a, buffer_bytes, "a"),
               in_b = device::adopt_buffer(device, b, buffer_bytes, "b"),
               out = device::adopt_buffer(device, dst, buffer_bytes, "dst");
    const auto part = [](const device::MemoryPtr& memory, std::uint64_t from) {
        return device::Slice<float>{{memory.get(), from, 12}};
    };
    run_kernel<kernels::Triad>(device, 3,
                               {.a = part(in_a, 0), .b = part(in_b, 0), .dst = part(out, 512)},
                               {.count = 3, .scale = 2});
}
void expect_result(const float* dst) {
    EXPECT_EQ(std::vector<float>(dst + 128, dst + 131), (std::vector<float>{21, 42, 63}));
    EXPECT_EQ(dst[131], 0.0f);
}

// A missing driver skips by name, or fails where the backends are required.
class DeviceAdopt : public ::testing::Test {
  protected:
    bool missing(const char* what) {
        EXPECT_FALSE(backends_required()) << what << " is missing";
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
        std::vector<float> a(buffer_bytes / 4), b = a, dst = a;
        a[0] = 1, a[1] = 2, a[2] = 3, b[0] = 10, b[1] = 20, b[2] = 30;
        const auto made = [&](std::vector<float>& from) {
            return clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, buffer_bytes,
                                  from.data(), nullptr);
        };
        cl_mem buffers[] = {made(a), made(b), made(dst)};
        use_buffers(*device, buffers[0], buffers[1], buffers[2]);
        EXPECT_THROW(device::adopt_buffer(*device, buffers[0], 77, "a"), Error);
        ASSERT_EQ(clEnqueueReadBuffer(queue, buffers[2], CL_TRUE, 0, buffer_bytes, dst.data(), 0,
                                      nullptr, nullptr),
                  CL_SUCCESS);
        expect_result(dst.data());
        for (cl_mem buffer : buffers) EXPECT_EQ(clReleaseMemObject(buffer), CL_SUCCESS);
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

// A buffer in memory that the host sees, as a caller might have it.
struct CallersVulkanBuffer {
    VkDevice device;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    float* values = nullptr;

    CallersVulkanBuffer(VkPhysicalDevice physical, VkDevice handle, std::vector<float> first)
        : device(handle) {
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = buffer_bytes;
        info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        EXPECT_EQ(vkCreateBuffer(device, &info, nullptr, &buffer), VK_SUCCESS);
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(device, buffer, &needs);
        VkPhysicalDeviceMemoryProperties kinds;
        vkGetPhysicalDeviceMemoryProperties(physical, &kinds);
        constexpr VkMemoryPropertyFlags wanted =
            VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        VkMemoryAllocateInfo allocation{};
        allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        allocation.allocationSize = needs.size;
        while ((kinds.memoryTypes[allocation.memoryTypeIndex].propertyFlags & wanted) != wanted ||
               !(needs.memoryTypeBits >> allocation.memoryTypeIndex & 1))
            ++allocation.memoryTypeIndex;
        EXPECT_EQ(vkAllocateMemory(device, &allocation, nullptr, &memory), VK_SUCCESS);
        EXPECT_EQ(vkBindBufferMemory(device, buffer, memory, 0), VK_SUCCESS);
        void* address = nullptr;
        EXPECT_EQ(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &address), VK_SUCCESS);
        values = static_cast<float*>(address);
        std::fill_n(values, buffer_bytes / 4, 0.0f);
        std::copy(first.begin(), first.end(), values);
    }
    ~CallersVulkanBuffer() {
        vkDestroyBuffer(device, buffer, nullptr);
        vkFreeMemory(device, memory, nullptr);
    }
    CallersVulkanBuffer(const CallersVulkanBuffer&) = delete;
    CallersVulkanBuffer& operator=(const CallersVulkanBuffer&) = delete;
};

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
        const CallersVulkanBuffer a(devices[0], handle, {1, 2, 3}),
            b(devices[0], handle, {10, 20, 30}), dst(devices[0], handle, {});
        use_buffers(*device, a.buffer, b.buffer, dst.buffer);
        expect_result(dst.values);
    }
    EXPECT_THROW(device::adopt_vulkan({instance, devices[0], handle, queue, family_count}), Error);
    EXPECT_EQ(vkDeviceWaitIdle(handle), VK_SUCCESS);
    vkDestroyDevice(handle, nullptr);
    vkDestroyInstance(instance, nullptr);
}

TEST_F(DeviceAdopt, RefusesNullHandles) {
    EXPECT_THROW(device::adopt_opencl({}), Error);
    EXPECT_THROW(device::adopt_vulkan({}), Error);
    float memory[4];
    EXPECT_THROW(device::adopt_buffer(*device::open_device("native"), memory, 16, "a"), Error);
}

}  // namespace
}  // namespace topple::test
