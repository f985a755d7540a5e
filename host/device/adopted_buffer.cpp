// SPDX-License-Identifier: MIT
#include "device/adopted_buffer.h"

#include "device/opencl/opencl_device.h"
#include "device/opencl/opencl_error.h"
#include "device/vulkan/vulkan_device.h"
#include "topple/error.h"

namespace topple::device {
namespace {

template <class T>
T memory_value(cl_mem memory, cl_mem_info what, const std::string& name) {
    T value{};
    cl_check(clGetMemObjectInfo(memory, what, sizeof(value), &value, nullptr), "buffer " + name);
    return value;
}

void check(const OpenClDevice& device, cl_mem memory, std::uint64_t bytes,
           const std::string& name) {
    if (memory_value<cl_context>(memory, CL_MEM_CONTEXT, name) != device.handles().context)
        throw Error(ErrorKind::device, "buffer " + name + " is of another OpenCL context");
    const auto size = memory_value<std::size_t>(memory, CL_MEM_SIZE, name);
    if (size != bytes) {
        throw Error(ErrorKind::device, "buffer " + name + ": the cl_mem has " +
                                           std::to_string(size) + " bytes, not " +
                                           std::to_string(bytes));
    }
}

}  // namespace

MemoryPtr adopt_buffer(Device& device, void* handle, std::uint64_t bytes, const std::string& name) {
    if (auto* opencl = dynamic_cast<OpenClDevice*>(&device)) {
        check(*opencl, static_cast<cl_mem>(handle), bytes, name);
        return {new OpenClMemory(*opencl, static_cast<cl_mem>(handle), bytes, name), {&device}};
    }
    if (auto* vulkan = dynamic_cast<VulkanDevice*>(&device)) {
        return {new VulkanMemory(*vulkan, static_cast<VkBuffer>(handle), bytes, name), {&device}};
    }
    throw Error(ErrorKind::device, "buffer " + name + ": the " + to_string(device.info().backend) +
                                       " backend has no buffers; give an array in host memory");
}

}  // namespace topple::device
