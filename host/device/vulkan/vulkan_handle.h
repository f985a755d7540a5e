// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <string>
#include <type_traits>

#include "device/vulkan/vulkan_error.h"

namespace topple::device {

template <class T>
struct VulkanDestroy {
    using pointer = T;
    VkDevice device = VK_NULL_HANDLE;
    void(VKAPI_PTR* destroy)(VkDevice, T, const VkAllocationCallbacks*) = nullptr;
    void operator()(T object) const { destroy(device, object, nullptr); }
};

// An object that a logical device has made, and what ends it.
template <class T>
using VulkanHandle = std::unique_ptr<std::remove_pointer_t<T>, VulkanDestroy<T>>;

// What vkCreate...() makes of its info. Throws Error(device) "<what>: <name of result>".
template <class T, class Info>
VulkanHandle<T> vk_make(VkDevice device,
                        VkResult(VKAPI_PTR* create)(VkDevice, const Info*,
                                                    const VkAllocationCallbacks*, T*),
                        void(VKAPI_PTR* destroy)(VkDevice, T, const VkAllocationCallbacks*),
                        const Info& info, const std::string& what) {
    T made = VK_NULL_HANDLE;
    vk_check(create(device, &info, nullptr, &made), what);
    return {made, {device, destroy}};
}

}  // namespace topple::device
