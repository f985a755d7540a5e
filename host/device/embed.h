// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "device/device.h"

// Running on a device that the caller already has. The handles stay the caller's: they are neither
// retained beyond the Device's life nor destroyed by it. They are passed as opaque pointers so that
// this header needs neither the Vulkan nor the OpenCL headers.
namespace topple::device {

struct VulkanHandles {
    void* instance;         // VkInstance
    void* physical_device;  // VkPhysicalDevice
    void* device;           // VkDevice
    void* queue;  // VkQueue that supports compute; the caller does not submit to it meanwhile
    std::uint32_t queue_family;
};

struct OpenClHandles {
    void* context;    // cl_context
    void* device_id;  // cl_device_id
    void* queue;      // cl_command_queue, in order
};

std::unique_ptr<Device> adopt_vulkan(const VulkanHandles& handles);
std::unique_ptr<Device> adopt_opencl(const OpenClHandles& handles);

}  // namespace topple::device
