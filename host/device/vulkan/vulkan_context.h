// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/devices.h"
#include "device/vulkan/float_controls.h"
#include "topple/kernels/device.h"

namespace topple::device {

// What the validation layers have reported since it was last taken.
struct ValidationLog {
    std::vector<std::string> messages;
};

// An instance, one physical device, its logical device and a compute queue; destroyed at the end
// only where `owned`.
struct VulkanContext {
    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    bool owned = false;
    // What the device was opened with; of one that is the caller's nothing is known.
    FloatControls float_controls;
    std::unique_ptr<ValidationLog> log;  // null without validation

    VulkanContext() = default;
    VulkanContext(const VulkanContext&) = delete;
    VulkanContext& operator=(const VulkanContext&) = delete;
    ~VulkanContext();
};

// Opens the best usable device: a discrete, integrated or virtual GPU before a CPU, then in the
// loader's order. With TOPPLE_VULKAN_VALIDATION=1 in the environment the validation layer is on,
// where it is installed. Throws Error(device) with what would mend it.
std::unique_ptr<VulkanContext> open_vulkan_context();

// What a device says of itself.
DeviceInfo describe_vulkan(VkPhysicalDevice physical);

// Why a physical device can't be used; empty where it can.
std::string vulkan_problem(VkPhysicalDevice physical);

// How many low bits of its timestamps count in this family of queues; 0 where it writes none.
std::uint32_t timestamp_bits(VkPhysicalDevice physical, std::uint32_t family);

// Whether the device has this family of queues, and the family computes.
bool family_computes(VkPhysicalDevice physical, std::uint32_t family);

}  // namespace topple::device
