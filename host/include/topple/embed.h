// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "topple/device.h"

// Running on a device that the caller already has. The handles stay the caller's: they are not
// destroyed, and must outlive the last copy of the pointer that came of them. Nobody else uses the
// queue during a parse, nor while that last copy goes. Handles are passed as opaque pointers, so
// that this header needs neither the Vulkan nor the OpenCL headers; what is no such handle can't be
// told from one, and is undefined behaviour.
namespace topple::device {

struct VulkanHandles {
    void* instance = nullptr;         // VkInstance, made for Vulkan 1.1 or later
    void* physical_device = nullptr;  // VkPhysicalDevice that offers Vulkan 1.1 or later
    void* device = nullptr;           // VkDevice; no extension or feature needs to be on
    void* queue = nullptr;            // VkQueue of `device`
    std::uint32_t queue_family = 0;   // the queue's family, which must support compute
};

struct OpenClHandles {
    void* context = nullptr;    // cl_context
    void* device_id = nullptr;  // cl_device_id of that context, OpenCL 1.2 or later
    void* queue = nullptr;      // cl_command_queue of that device, in order
};

// Both throw Error(device) where a handle is null or the device lacks what is said above.
std::shared_ptr<Device> adopt_vulkan(const VulkanHandles& handles);
std::shared_ptr<Device> adopt_opencl(const OpenClHandles& handles);

}  // namespace topple::device
