// SPDX-License-Identifier: MIT
#include "device/devices.h"
#include "device/vulkan/vulkan_device.h"

namespace topple::device {

std::shared_ptr<Device> open_form(const std::string& form) {
    VulkanOptions options;
    if (form == "vulkan_as_gpu")
        options.force_gpu_form = true;
    else if (form == "vulkan_small_bindings")
        options.max_binding_bytes = 1u << 20;
    else
        return open_device(form);
    return std::make_shared<VulkanDevice>(open_vulkan_context(), options);
}

}  // namespace topple::device
