// SPDX-License-Identifier: MIT
#include "device/devices.h"
#include "device/vulkan/vulkan_device.h"

namespace topple::device {

std::shared_ptr<Device> open_form(const std::string& form) {
    if (form != "vulkan_as_gpu") return open_device(form);
    return std::make_shared<VulkanDevice>(open_vulkan_context(),
                                          VulkanOptions{.force_gpu_form = true});
}

}  // namespace topple::device
