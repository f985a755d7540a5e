// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

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

VulkanMemory::VulkanMemory(VulkanDevice& device, std::uint64_t bytes, std::string name)
    : device_(device),
      bytes_(bytes),
      name_(std::move(name)),
      buffer_(device.create_storage(bytes + vulkan_tail, name_)) {}

VulkanMemory::VulkanMemory(VulkanDevice& device, VkBuffer buffer, std::uint64_t bytes,
                           std::string name)
    : device_(device), bytes_(bytes), name_(std::move(name)), owned_(false) {
    buffer_.buffer = buffer;
}

VulkanMemory::~VulkanMemory() {
    if (owned_) device_.destroy(buffer_);
}

std::unique_ptr<Memory> VulkanDevice::allocate(std::uint64_t bytes, const std::string& name) {
    if (bytes > info_.limits.max_allocation_bytes) {
        throw Error(
            ErrorKind::device,
            "buffer " + name + ": " + std::to_string(bytes) + " bytes are more than the " +
                std::to_string(info_.limits.max_allocation_bytes) + " that " + info_.name +
                " allocates at once; use a larger ParseOptions::voxel_m, or the native backend");
    }
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
    VulkanBuffer made;
    try {
        auto info = vk_struct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
        info.size = bytes;
        info.usage = usage;
        vk_check(vkCreateBuffer(context_.device, &info, nullptr, &made.buffer), what);
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(context_.device, made.buffer, &needs);
        const std::int64_t type = memory_type(needs.memoryTypeBits, required, preferred);
        if (type < 0) throw Error(ErrorKind::device, what + ": no fitting kind of memory");
        auto allocation = vk_struct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
        allocation.allocationSize = needs.size;
        allocation.memoryTypeIndex = static_cast<std::uint32_t>(type);
        vk_check(vkAllocateMemory(context_.device, &allocation, nullptr, &made.memory), what);
        vk_check(vkBindBufferMemory(context_.device, made.buffer, made.memory, 0), what);
        if (required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
            void* address = nullptr;
            vk_check(vkMapMemory(context_.device, made.memory, 0, VK_WHOLE_SIZE, 0, &address),
                     what);
            made.mapped = static_cast<std::byte*>(address);
        }
    } catch (const Error&) {
        destroy(made);
        throw;
    }
    return made;
}

void VulkanDevice::destroy(VulkanBuffer& buffer) const {
    if (buffer.buffer) vkDestroyBuffer(context_.device, buffer.buffer, nullptr);
    if (buffer.memory) vkFreeMemory(context_.device, buffer.memory, nullptr);  // unmaps too
    buffer = {};
}

VulkanMemory& VulkanDevice::own(Memory& memory) const {
    auto* mine = dynamic_cast<VulkanMemory*>(&memory);
    if (!mine || &mine->device() != this) {
        throw Error(ErrorKind::device,
                    "buffer " + memory.name() + " belongs to another device than " + info_.name);
    }
    return *mine;
}

void VulkanDevice::copy(VkBuffer from, std::uint64_t from_offset, VkBuffer to,
                        std::uint64_t to_offset, std::uint64_t bytes, const std::string& what) {
    begin();
    const VkBufferCopy region{from_offset, to_offset, bytes};
    vkCmdCopyBuffer(commands_, from, to, 1, &region);
    submit(what);
}

void VulkanDevice::write(Memory& to, std::uint64_t offset, std::span<const std::byte> from) {
    VulkanMemory& memory = own(to);
    if (std::byte* address = memory.host_address()) {
        std::memcpy(address + offset, from.data(), from.size());
    } else {
        for (std::uint64_t done = 0; done < from.size(); done += options_.staging_bytes) {
            const std::uint64_t piece =
                std::min<std::uint64_t>(options_.staging_bytes, from.size() - done);
            std::memcpy(staging_.mapped, from.data() + done, piece);
            copy(staging_.buffer, 0, memory.buffer(), offset + done, piece,
                 "writing buffer " + memory.name());
        }
    }
    counters_.bytes_written += from.size();
}

void VulkanDevice::read(Memory& from, std::uint64_t offset, std::span<std::byte> to) {
    VulkanMemory& memory = own(from);
    if (const std::byte* address = memory.host_address()) {
        std::memcpy(to.data(), address + offset, to.size());
    } else {
        for (std::uint64_t done = 0; done < to.size(); done += options_.staging_bytes) {
            const std::uint64_t piece =
                std::min<std::uint64_t>(options_.staging_bytes, to.size() - done);
            copy(memory.buffer(), offset + done, staging_.buffer, 0, piece,
                 "reading buffer " + memory.name());
            std::memcpy(to.data() + done, staging_.mapped, piece);
        }
    }
    counters_.bytes_read += to.size();
}

void VulkanDevice::fill(Memory& target, std::uint64_t offset, std::uint64_t bytes,
                        std::uint32_t word) {
    VulkanMemory& memory = own(target);
    if (std::byte* address = memory.host_address()) {
        auto* first = reinterpret_cast<std::uint32_t*>(address + offset);
        std::fill(first, first + bytes / sizeof(word), word);
        return;
    }
    begin();
    vkCmdFillBuffer(commands_, memory.buffer(), offset, bytes, word);
    submit("filling buffer " + memory.name());
}

}  // namespace topple::device
