// SPDX-License-Identifier: MIT
#include "device/vulkan/timestamps.h"

#include "device/trace.h"
#include "device/vulkan/vulkan_error.h"

namespace topple::device {

VulkanTimestamps::VulkanTimestamps(const VulkanContext& context, std::uint32_t bits)
    : device_(context.device), mask_(~std::uint64_t{0} >> (64 - bits)) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(context.physical, &properties);
    period_ns_ = static_cast<double>(properties.limits.timestampPeriod);
}

void VulkanTimestamps::begin(VkCommandBuffer commands, std::uint32_t dispatches) {
    if (dispatches + 1 > capacity_) {
        capacity_ = dispatches + 1;
        auto info = vk_struct<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = capacity_;
        pool_ = vk_make(device_, vkCreateQueryPool, vkDestroyQueryPool, info, "timestamps");
    }
    vkCmdResetQueryPool(commands, pool_.get(), 0, capacity_);
    count_ = 0;
    mark(commands);
}

void VulkanTimestamps::mark(VkCommandBuffer commands) {
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, pool_.get(), count_++);
}

std::vector<DispatchTime> VulkanTimestamps::times() const {
    std::vector<std::uint64_t> ticks(count_);
    vk_check(vkGetQueryPoolResults(device_, pool_.get(), 0, count_, ticks.size() * sizeof(ticks[0]),
                                   ticks.data(), sizeof(ticks[0]),
                                   VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
             "timestamps");
    // The clock may have begun anew in between: the difference within its bits is right all the
    // same.
    const auto before_end = [&](std::uint64_t tick) {
        return -static_cast<std::int64_t>(static_cast<double>((ticks.back() - tick) & mask_) *
                                          period_ns_);
    };
    std::vector<DispatchTime> times;
    for (std::size_t d = 0; d + 1 < ticks.size(); ++d)
        times.push_back({before_end(ticks[d]), before_end(ticks[d + 1])});
    return times;
}

}  // namespace topple::device
