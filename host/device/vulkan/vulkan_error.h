// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan.h>

#include <string>

namespace topple::device {

// The specification's name of a Vulkan result.
std::string vk_result_name(VkResult result);

// A Vulkan structure with its type set and all else zero.
template <class T>
T vk_struct(VkStructureType type) {
    T made{};
    made.sType = type;
    return made;
}

// Throws Error(device) "<what>: <name of result>" unless result is VK_SUCCESS.
void vk_check(VkResult result, const std::string& what);

}  // namespace topple::device
