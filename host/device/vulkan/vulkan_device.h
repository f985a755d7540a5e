// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/vulkan/timestamps.h"
#include "device/vulkan/vulkan_context.h"
#include "device/vulkan/vulkan_handle.h"
#include "topple/kernels/device.h"

namespace topple::device {

// Choices that follow from the device; tests set them to run, on any driver, the paths that others
// need.
struct VulkanOptions {
    bool force_gpu_form = false;  // kernels as for real GPUs, which may divide inexactly
    bool force_staging = false;   // copy through a staging buffer even where memory is unified
    std::uint64_t staging_bytes = 16u << 20;
    std::uint64_t max_binding_bytes = 0;  // of one binding; 0: the device's limit
    std::uint32_t max_groups = 0;         // groups in one command; 0: the device's limit
    std::uint32_t dispatches_per_submit = 4096;
};

// A VkBuffer with memory of its own. `mapped` is null where the host can't see the memory.
struct VulkanBuffer {
    VulkanHandle<VkDeviceMemory> memory;
    VulkanHandle<VkBuffer> buffer;
    std::byte* mapped = nullptr;
};

// Commands on their way through the queue, and what they need until they have ended.
struct VulkanCommands {
    VkCommandBuffer buffer = VK_NULL_HANDLE;  // of the device's pool
    VulkanHandle<VkFence> fence;
    VulkanHandle<VkDescriptorPool> descriptors;
    std::uint32_t most_sets = 0, most_descriptors = 0;
    std::string what;  // for messages
};

class VulkanDevice;

class VulkanMemory final : public Memory {
  public:
    VulkanMemory(const VulkanDevice& device, std::uint64_t bytes, const std::string& name);
    // The caller's buffer, which stays theirs.
    VulkanMemory(const VulkanDevice& device, VkBuffer buffer, std::uint64_t bytes,
                 const std::string& name);

    std::byte* host_address() override { return own_.mapped; }
    VkBuffer buffer() const { return buffer_; }

  private:
    VulkanBuffer own_;  // or none
    VkBuffer buffer_;
};

class VulkanDevice final : public Device {
  public:
    explicit VulkanDevice(std::unique_ptr<VulkanContext> context,
                          const VulkanOptions& options = {});
    ~VulkanDevice() override;

    void prepare(const KernelSource& kernel) override;

    // Whether the validation layers watch.
    bool validates() const { return context_->log != nullptr; }

    // What the kernels' arrays lie in, and what copies to and from them pass through.
    VulkanBuffer create_storage(std::uint64_t bytes, const std::string& name) const;
    VulkanBuffer create_staging(std::uint64_t bytes) const;

  private:
    class Batch;
    std::unique_ptr<Memory> make_memory(std::uint64_t bytes, const std::string& name) override;
    std::unique_ptr<Running> begin(std::vector<Dispatch> batch, bool at_once) override;
    void send(Memory& to, std::uint64_t offset, std::span<const std::byte> from) override;
    void fetch(Memory& from, std::uint64_t offset, std::span<std::byte> to) override;
    void fill_apart(Memory& memory, std::uint64_t offset, std::uint64_t bytes,
                    std::uint32_t word) override;
    std::string time_dispatches() override;
    struct Built {
        VulkanHandle<VkDescriptorSetLayout> set_layout;
        VulkanHandle<VkPipelineLayout> layout;
        VulkanHandle<VkPipeline> pipeline;
    };
    VulkanBuffer create_buffer(std::uint64_t bytes, VkBufferUsageFlags usage,
                               VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred,
                               const std::string& name) const;
    std::int64_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags required,
                             VkMemoryPropertyFlags preferred) const;
    const Built& kernel(const KernelSource& source);
    Built build(const KernelSource& source) const;
    void reserve_descriptors(VulkanCommands& commands, std::span<const Dispatch> dispatches);
    VkDescriptorSet describe(const VulkanCommands& commands, const Dispatch& dispatch,
                             const Built& built);
    void add_commands(const VulkanCommands& commands, const Dispatch& dispatch);
    VulkanCommands begin_part(std::span<const Dispatch> dispatches);
    VulkanCommands new_commands() const;
    VulkanCommands take_commands();
    void submit(VulkanCommands& commands, const std::string& what);
    void wait(const VulkanCommands& commands);
    void submit_and_wait(VulkanCommands commands, const std::string& what);
    void copy(VkBuffer from, std::uint64_t from_offset, VkBuffer to, std::uint64_t to_offset,
              std::uint64_t bytes, const std::string& what);
    void check_validation(const std::string& what);

    std::unique_ptr<VulkanContext> context_;
    VulkanOptions options_;
    bool unified_ = false;
    std::uint32_t max_groups_ = 0;
    VkPhysicalDeviceMemoryProperties memory_{};
    VulkanHandle<VkCommandPool> command_pool_;
    std::vector<VulkanCommands> spare_;           // that have ended
    std::optional<VulkanTimestamps> timestamps_;  // where they are recorded, and the queue has any
    VulkanBuffer staging_;
    std::map<const KernelSource*, Built> kernels_;  // looked up only, never iterated for a result
};

}  // namespace topple::device
