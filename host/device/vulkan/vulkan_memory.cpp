// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <utility>

#include "device/vulkan/vulkan_device.h"
#include "device/vulkan/vulkan_error.h"
#include "topple/error.h"

namespace topple::device {
namespace {

constexpr VkMemoryPropertyFlags host_coherent =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkBufferUsageFlags copied =
    VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
// An empty slice at a buffer's very end still binds something.
constexpr std::uint64_t vulkan_tail = 16;

}  // namespace

VulkanMemory::VulkanMemory(const VulkanDevice& device, std::uint64_t bytes, const std::string& name)
    : Memory(device, bytes, name),
      own_(device.create_storage(bytes + vulkan_tail, name)),
      buffer_(own_.buffer.get()) {}

VulkanMemory::VulkanMemory(const VulkanDevice& device, VkBuffer buffer, std::uint64_t bytes,
                           const std::string& name)
    : Memory(device, bytes, name), buffer_(buffer) {}

std::unique_ptr<Memory> VulkanDevice::make_memory(std::uint64_t bytes, const std::string& name) {
    return std::make_unique<VulkanMemory>(*this, bytes, name);
}

VulkanBuffer VulkanDevice::create_storage(std::uint64_t bytes, const std::string& name) const {
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | copied;
    // Unified memory is read by the host in place: cached, where there is a choice.
    if (unified_)
        return create_buffer(bytes, usage, host_coherent, VK_MEMORY_PROPERTY_HOST_CACHED_BIT, name);
    return create_buffer(bytes, usage, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, name);
}

VulkanBuffer VulkanDevice::create_staging(std::uint64_t bytes) const {
    return create_buffer(bytes, copied, host_coherent, VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
                         "staging");
}

std::int64_t VulkanDevice::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags required,
                                       VkMemoryPropertyFlags preferred) const {
    std::int64_t best = -1;
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
        const VkMemoryPropertyFlags flags = memory_.memoryTypes[i].propertyFlags;
        if (!(allowed >> i & 1) || (flags & required) != required) continue;
        if ((flags & preferred) == preferred) return i;
        if (best < 0) best = i;
    }
    return best;
}

VulkanBuffer VulkanDevice::create_buffer(std::uint64_t bytes, VkBufferUsageFlags usage,
                                         VkMemoryPropertyFlags required,
                                         VkMemoryPropertyFlags preferred,
                                         const std::string& name) const {
    const std::string what =
        "buffer " + name + " of " + std::to_string(bytes) + " bytes on " + info_.name;
    const VkDevice device = context_->device;
    VulkanBuffer made;
    auto info = vk_struct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = bytes;
    info.usage = usage;
    made.buffer = vk_make(device, vkCreateBuffer, vkDestroyBuffer, info, what);
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, made.buffer.get(), &needs);
    const std::int64_t type = memory_type(needs.memoryTypeBits, required, preferred);
    if (type < 0) throw Error(ErrorKind::device, what + ": no fitting kind of memory");
    auto allocation = vk_struct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = static_cast<std::uint32_t>(type);
    made.memory = vk_make(device, vkAllocateMemory, vkFreeMemory, allocation, what);
    vk_check(vkBindBufferMemory(device, made.buffer.get(), made.memory.get(), 0), what);
    if (required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
        void* address = nullptr;
        vk_check(vkMapMemory(device, made.memory.get(), 0, VK_WHOLE_SIZE, 0, &address), what);
        made.mapped = static_cast<std::byte*>(address);
    }
    return made;
}

void VulkanDevice::copy(VkBuffer from, std::uint64_t from_offset, VkBuffer to,
                        std::uint64_t to_offset, std::uint64_t bytes, const std::string& what) {
    VulkanCommands commands = take_commands();
    const VkBufferCopy region{from_offset, to_offset, bytes};
    vkCmdCopyBuffer(commands.buffer, from, to, 1, &region);
    submit_and_wait(std::move(commands), what);
}

void VulkanDevice::send(Memory& to, std::uint64_t offset, std::span<const std::byte> from) {
    for (std::uint64_t done = 0; done < from.size(); done += options_.staging_bytes) {
        const std::uint64_t piece =
            std::min<std::uint64_t>(options_.staging_bytes, from.size() - done);
        std::memcpy(staging_.mapped, from.data() + done, piece);
        copy(staging_.buffer.get(), 0, own<VulkanMemory>(to).buffer(), offset + done, piece,
             "writing buffer " + to.name());
    }
}

void VulkanDevice::fetch(Memory& from, std::uint64_t offset, std::span<std::byte> to) {
    for (std::uint64_t done = 0; done < to.size(); done += options_.staging_bytes) {
        const std::uint64_t piece =
            std::min<std::uint64_t>(options_.staging_bytes, to.size() - done);
        copy(own<VulkanMemory>(from).buffer(), offset + done, staging_.buffer.get(), 0, piece,
             "reading buffer " + from.name());
        std::memcpy(to.data() + done, staging_.mapped, piece);
    }
}

void VulkanDevice::fill_apart(Memory& memory, std::uint64_t offset, std::uint64_t bytes,
                              std::uint32_t word) {
    VulkanCommands commands = take_commands();
    vkCmdFillBuffer(commands.buffer, own<VulkanMemory>(memory).buffer(), offset, bytes, word);
    submit_and_wait(std::move(commands), "filling buffer " + memory.name());
}

}  // namespace topple::device
