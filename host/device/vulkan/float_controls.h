// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <vector>

namespace topple::device {

// What a driver can be asked to do with 32-bit floats (VK_KHR_shader_float_controls) where Vulkan
// leaves it the choice: all backends give the same bits.
struct FloatControls {
    bool denormals = false;       // are kept, not flushed to zero
    bool nearest_even = false;    // is what results are rounded to
    bool special_values = false;  // signs of zeros, infinities and NaN are kept

    bool any() const { return denormals || nearest_even || special_values; }
};

// What the device has of it; nothing where it lacks the extension.
FloatControls float_controls_of(VkPhysicalDevice physical);

// The module with these asked for by its entry point: SPV_KHR_float_controls.
std::vector<std::uint32_t> with_float_controls(std::span<const std::uint32_t> spirv,
                                               const FloatControls& controls);

}  // namespace topple::device
