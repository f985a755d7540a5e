// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>
#include <vector>

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

// All of what get(&count, to) tells how many there are, and then writes.
template <class T, class Get>
std::vector<T> vk_list(const Get& get) {
    std::uint32_t count = 0;
    get(&count, nullptr);
    std::vector<T> all(count);
    get(&count, all.data());
    return all;
}

// Throws Error(device) "<what>: <name of result>" unless result is VK_SUCCESS.
void vk_check(VkResult result, const std::string& what);

}  // namespace topple::device
