// SPDX-License-Identifier: MIT
#include "device/vulkan/float_controls.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "device/vulkan/vulkan_error.h"

namespace topple::device {
namespace {

constexpr std::size_t spirv_header_words = 5;

// Numbers of the SPIR-V specification and of SPV_KHR_float_controls.
enum Opcode : std::uint32_t {
    op_extension = 10,
    op_entry_point = 15,
    op_execution_mode = 16,
    op_capability = 17
};
struct Mode {
    std::uint32_t capability, execution_mode;
};
constexpr Mode denorm_preserve{4464, 4459}, signed_zero_inf_nan_preserve{4466, 4461},
    rounding_mode_rte{4467, 4462};

std::uint32_t opcode_and_length(Opcode opcode, std::uint32_t words) {
    return words << 16 | opcode;
}

}  // namespace

FloatControls float_controls_of(VkPhysicalDevice physical) {
    const auto extensions =
        vk_list<VkExtensionProperties>([&](std::uint32_t* count, VkExtensionProperties* to) {
            vk_check(vkEnumerateDeviceExtensionProperties(physical, nullptr, count, to),
                     "listing extensions");
        });
    const bool has = std::ranges::any_of(extensions, [](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME) ==
               0;
    });
    if (!has) return {};
    auto controls = vk_struct<VkPhysicalDeviceFloatControlsProperties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES);
    auto two =
        vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    two.pNext = &controls;
    vkGetPhysicalDeviceProperties2(physical, &two);
    return {.denormals = controls.shaderDenormPreserveFloat32 == VK_TRUE,
            .nearest_even = controls.shaderRoundingModeRTEFloat32 == VK_TRUE,
            .special_values = controls.shaderSignedZeroInfNanPreserveFloat32 == VK_TRUE};
}

std::vector<std::uint32_t> with_float_controls(std::span<const std::uint32_t> spirv,
                                               const FloatControls& controls) {
    std::vector<Mode> modes;
    if (controls.denormals) modes.push_back(denorm_preserve);
    if (controls.special_values) modes.push_back(signed_zero_inf_nan_preserve);
    if (controls.nearest_even) modes.push_back(rounding_mode_rte);
    std::vector<std::uint32_t> out(spirv.begin(), spirv.end());
    if (modes.empty()) return out;

    // A module's parts stand in order: capabilities, extensions, ..., entry points, modes.
    std::size_t after_capabilities = spirv_header_words, after_entry_point = 0;
    std::uint32_t entry_point = 0;
    for (std::size_t at = spirv_header_words; at < spirv.size(); at += spirv[at] >> 16) {
        const std::uint32_t opcode = spirv[at] & 0xffff, words = spirv[at] >> 16;
        if (opcode == op_capability) after_capabilities = at + words;
        if (opcode == op_entry_point) {
            after_entry_point = at + words;
            entry_point = spirv[at + 2];
        }
    }
    std::vector<std::uint32_t> asked, needed;
    for (const Mode& mode : modes) {
        asked.insert(asked.end(), {opcode_and_length(op_execution_mode, 4), entry_point,
                                   mode.execution_mode, 32});
        needed.insert(needed.end(), {opcode_and_length(op_capability, 2), mode.capability});
    }
    constexpr std::string_view name = "SPV_KHR_float_controls";
    std::array<std::uint32_t, name.size() / 4 + 1> text{};
    std::memcpy(text.data(), name.data(), name.size());
    needed.push_back(opcode_and_length(op_extension, 1 + text.size()));
    needed.insert(needed.end(), text.begin(), text.end());
    out.insert(out.begin() + static_cast<std::ptrdiff_t>(after_entry_point), asked.begin(),
               asked.end());
    out.insert(out.begin() + static_cast<std::ptrdiff_t>(after_capabilities), needed.begin(),
               needed.end());
    return out;
}

}  // namespace topple::device
