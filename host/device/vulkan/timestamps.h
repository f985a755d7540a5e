// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <vector>

#include "device/trace.h"
#include "device/vulkan/vulkan_context.h"
#include "device/vulkan/vulkan_handle.h"

namespace topple::device {

// The device's own clock, read by its queue between the dispatches of a batch.
class VulkanTimestamps {
  public:
    VulkanTimestamps(const VulkanContext& context, std::uint32_t bits);

    // Commands of a batch: before its first dispatch, and after each.
    void begin(VkCommandBuffer commands, std::uint32_t dispatches);
    void mark(VkCommandBuffer commands);
    // When each ran, once the batch has ended: in ns, 0 where the last one ended.
    std::vector<DispatchTime> times() const;

  private:
    VkDevice device_;
    std::uint64_t mask_;  // of the bits that count
    double period_ns_;    // of one tick
    VulkanHandle<VkQueryPool> pool_;
    std::uint32_t capacity_ = 0, count_ = 0;
};

}  // namespace topple::device
