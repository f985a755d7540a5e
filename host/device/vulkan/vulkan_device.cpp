// SPDX-License-Identifier: MIT
#include "device/vulkan/vulkan_device.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "device/devices.h"
#include "device/timeline.h"
#include "device/trace.h"
#include "device/vulkan/vulkan_error.h"
#include "topple/embed.h"
#include "topple/error.h"

namespace topple::device {

VulkanDevice::VulkanDevice(std::unique_ptr<VulkanContext> context, const VulkanOptions& options)
    : context_(std::move(context)), options_(options) {
    info_ = describe_vulkan(context_->physical);
    as_gpu_ = info_.gpu || options_.force_gpu_form;
    if (options_.max_binding_bytes) info_.limits.max_binding_bytes = options_.max_binding_bytes;
    vkGetPhysicalDeviceMemoryProperties(context_->physical, &memory_);
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(context_->physical, &properties);
    max_groups_ =
        options_.max_groups ? options_.max_groups : properties.limits.maxComputeWorkGroupCount[0];
    unified_ = !options_.force_staging &&
               (properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU ||
                properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU);
    auto pool = vk_struct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = context_->queue_family;
    command_pool_ = vk_make(context_->device, vkCreateCommandPool, vkDestroyCommandPool, pool,
                            info_.name + ": command pool");
    pool_memory();
    if (!unified_) staging_ = create_staging(options_.staging_bytes);
    record(Trace::of_environment());
}

VulkanDevice::~VulkanDevice() {
    settle();
    vkQueueWaitIdle(context_->queue);
}

void VulkanDevice::check_validation(const std::string& what) {
    if (!context_->log || context_->log->messages.empty()) return;
    const std::string first = context_->log->messages.front();
    context_->log->messages.clear();
    throw Error(ErrorKind::device, what + ": Vulkan validation: " + first);
}

void VulkanDevice::prepare(const KernelSource& source) {
    kernel(source);
}

const VulkanDevice::Built& VulkanDevice::kernel(const KernelSource& source) {
    auto found = kernels_.find(&source);
    if (found == kernels_.end()) {
        const TraceSpan span(trace(), "build", source.name);
        found = kernels_.emplace(&source, build(source)).first;
        ++counters_.kernel_builds;
        check_validation(std::string("kernel ") + source.name);
    }
    return found->second;
}

VulkanDevice::Built VulkanDevice::build(const KernelSource& source) const {
    const std::string where =
        std::string("kernel ") + source.name + " does not build for " + info_.name;
    if (source.group_size > info_.limits.max_group_size) {
        throw Error(ErrorKind::device,
                    where + ": its groups of " + std::to_string(source.group_size) +
                        " are more than the " + std::to_string(info_.limits.max_group_size) +
                        " work-items that can run together");
    }
    const VkDevice device = context_->device;
    Built built;
    std::vector<VkDescriptorSetLayoutBinding> bindings(source.bindings.size());
    for (std::uint32_t i = 0; i < bindings.size(); ++i) {
        bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT,
                       nullptr};
    }
    auto set = vk_struct<VkDescriptorSetLayoutCreateInfo>(
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    set.bindingCount = static_cast<std::uint32_t>(bindings.size());
    set.pBindings = bindings.data();
    built.set_layout =
        vk_make(device, vkCreateDescriptorSetLayout, vkDestroyDescriptorSetLayout, set, where);
    const VkDescriptorSetLayout set_layout = built.set_layout.get();
    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, source.params_bytes};
    auto layout =
        vk_struct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &set_layout;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    built.layout = vk_make(device, vkCreatePipelineLayout, vkDestroyPipelineLayout, layout, where);
    auto code = vk_struct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    const auto words = with_float_controls(source.spirv, context_->float_controls);
    code.codeSize = words.size() * sizeof(words[0]);
    code.pCode = words.data();
    const auto module = vk_make(device, vkCreateShaderModule, vkDestroyShaderModule, code, where);
    auto info =
        vk_struct<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    // Work-group counts beyond the device's limit are split; the base keeps GROUP_ID right.
    info.flags = VK_PIPELINE_CREATE_DISPATCH_BASE_BIT;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module.get();
    info.stage.pName = "main";
    // ITEMS, and whether the driver divides as IEEE 754 says (kernels/dialect/glsl/prelude.glsl).
    struct {
        std::uint32_t items;
        VkBool32 driver_is_exact;
    } const constants{items_per_lane(source), as_gpu_ ? VK_FALSE : VK_TRUE};
    const VkSpecializationMapEntry entries[] = {{0, 0, 4}, {1, 4, 4}};
    const VkSpecializationInfo specialization{2, entries, sizeof(constants), &constants};
    info.stage.pSpecializationInfo = &specialization;
    info.layout = built.layout.get();
    VkPipeline pipeline = VK_NULL_HANDLE;
    vk_check(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), where);
    built.pipeline = {pipeline, {device, vkDestroyPipeline}};
    return built;
}

// Makes room for one descriptor set per dispatch; the pool only grows.
void VulkanDevice::reserve_descriptors(VulkanCommands& commands,
                                       std::span<const Dispatch> dispatches) {
    std::uint32_t descriptors = 1;
    for (const Dispatch& dispatch : dispatches) {
        descriptors += static_cast<std::uint32_t>(dispatch.ranges.size());
    }
    const auto sets = static_cast<std::uint32_t>(dispatches.size());
    if (commands.descriptors && sets <= commands.most_sets &&
        descriptors <= commands.most_descriptors) {
        vk_check(vkResetDescriptorPool(context_->device, commands.descriptors.get(), 0),
                 "descriptor pool");
        return;
    }
    commands.descriptors.reset();
    commands.most_sets = std::max(2 * commands.most_sets, sets);
    commands.most_descriptors = std::max(2 * commands.most_descriptors, descriptors);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, commands.most_descriptors};
    auto info =
        vk_struct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    info.maxSets = commands.most_sets;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    commands.descriptors = vk_make(context_->device, vkCreateDescriptorPool,
                                   vkDestroyDescriptorPool, info, "descriptor pool");
}

VkDescriptorSet VulkanDevice::describe(const VulkanCommands& commands, const Dispatch& dispatch,
                                       const Built& built) {
    auto info =
        vk_struct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    info.descriptorPool = commands.descriptors.get();
    info.descriptorSetCount = 1;
    const VkDescriptorSetLayout layout = built.set_layout.get();
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    vk_check(vkAllocateDescriptorSets(context_->device, &info, &set),
             std::string("kernel ") + dispatch.kernel->name + ": descriptor set");
    std::vector<VkDescriptorBufferInfo> buffers(dispatch.ranges.size());
    std::vector<VkWriteDescriptorSet> writes(dispatch.ranges.size());
    for (std::uint32_t i = 0; i < buffers.size(); ++i) {
        const BoundRange& range = dispatch.ranges[i];
        buffers[i] = {own<VulkanMemory>(*range.memory).buffer(), range.offset,
                      std::max<std::uint64_t>(4, range.bytes)};
        writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[i].dstSet = set;
        writes[i].dstBinding = i;
        writes[i].descriptorCount = 1;
        writes[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        writes[i].pBufferInfo = &buffers[i];
    }
    vkUpdateDescriptorSets(context_->device, static_cast<std::uint32_t>(writes.size()),
                           writes.data(), 0, nullptr);
    return set;
}

VulkanCommands VulkanDevice::new_commands() const {
    VulkanCommands made;
    auto buffer =
        vk_struct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    buffer.commandPool = command_pool_.get();
    buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer.commandBufferCount = 1;
    vk_check(vkAllocateCommandBuffers(context_->device, &buffer, &made.buffer),
             info_.name + ": command buffer");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
    made.fence =
        vk_make(context_->device, vkCreateFence, vkDestroyFence, fence, info_.name + ": fence");
    return made;
}

// Begun, and empty.
VulkanCommands VulkanDevice::take_commands() {
    if (spare_.empty()) spare_.push_back(new_commands());
    VulkanCommands commands = std::move(spare_.back());
    spare_.pop_back();
    auto info = vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    vk_check(vkBeginCommandBuffer(commands.buffer, &info), info_.name + ": command buffer");
    return commands;
}

// Ends the commands and submits them. What they wrote is visible to host, kernels and copies that
// come later.
void VulkanDevice::submit(VulkanCommands& commands, const std::string& what) {
    const VkMemoryBarrier written{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr,
                                  VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                                  VK_ACCESS_HOST_READ_BIT | VK_ACCESS_HOST_WRITE_BIT |
                                      VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                                      VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT};
    const VkPipelineStageFlags device_stages =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    vkCmdPipelineBarrier(commands.buffer, device_stages, device_stages | VK_PIPELINE_STAGE_HOST_BIT,
                         0, 1, &written, 0, nullptr, 0, nullptr);
    vk_check(vkEndCommandBuffer(commands.buffer), what);
    auto info = vk_struct<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands.buffer;
    const VkFence fence = commands.fence.get();
    vk_check(vkResetFences(context_->device, 1, &fence), what);
    vk_check(vkQueueSubmit(context_->queue, 1, &info, fence), what);
    commands.what = what;
}

void VulkanDevice::wait(const VulkanCommands& commands) {
    const TraceSpan span(trace(), "wait", commands.what);
    const VkFence fence = commands.fence.get();
    vk_check(vkWaitForFences(context_->device, 1, &fence, VK_TRUE, UINT64_MAX), commands.what);
    check_validation(commands.what);
}

void VulkanDevice::submit_and_wait(VulkanCommands commands, const std::string& what) {
    submit(commands, what);
    wait(commands);
    spare_.push_back(std::move(commands));
}

// The parts of a batch, in order.
class VulkanDevice::Batch final : public Running {
  public:
    explicit Batch(VulkanDevice& device) : device_(device) {}
    ~Batch() override {
        for (VulkanCommands& part : parts) device_.spare_.push_back(std::move(part));
    }
    bool ended() override {
        return vkGetFenceStatus(device_.context_->device, parts.back().fence.get()) != VK_NOT_READY;
    }
    std::exception_ptr wait() override {
        std::exception_ptr error;
        for (const VulkanCommands& part : parts) {
            try {
                device_.wait(part);
            } catch (const Error&) {
                if (!error) error = std::current_exception();
            }
        }
        return error;
    }

    std::vector<VulkanCommands> parts;

  private:
    VulkanDevice& device_;
};

void VulkanDevice::add_commands(const VulkanCommands& commands, const Dispatch& dispatch) {
    const Built& built = kernel(*dispatch.kernel);
    const VkDescriptorSet set = describe(commands, dispatch, built);
    vkCmdBindPipeline(commands.buffer, VK_PIPELINE_BIND_POINT_COMPUTE, built.pipeline.get());
    vkCmdBindDescriptorSets(commands.buffer, VK_PIPELINE_BIND_POINT_COMPUTE, built.layout.get(), 0,
                            1, &set, 0, nullptr);
    vkCmdPushConstants(commands.buffer, built.layout.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                       static_cast<std::uint32_t>(dispatch.params.size()), dispatch.params.data());
    for (std::uint64_t first = 0; first < dispatch.groups; first += max_groups_) {
        const std::uint64_t count = std::min<std::uint64_t>(max_groups_, dispatch.groups - first);
        vkCmdDispatchBase(commands.buffer, static_cast<std::uint32_t>(first), 0, 0,
                          static_cast<std::uint32_t>(count), 1, 1);
    }
}

// With a trace, waits: the timestamps are those of one part.
VulkanCommands VulkanDevice::begin_part(std::span<const Dispatch> dispatches) {
    VulkanCommands commands = take_commands();
    reserve_descriptors(commands, dispatches);
    if (timestamps_)
        timestamps_->begin(commands.buffer, static_cast<std::uint32_t>(dispatches.size()));
    const std::uint64_t cpu_before = trace() ? process_cpu_ns() : 0;
    const std::int64_t begin_ns = trace() ? to_ns(Trace::Clock::now()) : 0;
    const VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr,
                                  VK_ACCESS_SHADER_WRITE_BIT,
                                  VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT};
    for (std::size_t i = 0; i < dispatches.size(); ++i) {
        if (i > 0) {
            vkCmdPipelineBarrier(commands.buffer, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                 VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &barrier, 0, nullptr,
                                 0, nullptr);
        }
        add_commands(commands, dispatches[i]);
        if (timestamps_) timestamps_->mark(commands.buffer);
    }
    submit(commands, dispatches.size() == 1
                         ? std::string("kernel ") + dispatches[0].kernel->name
                         : "batch of " + std::to_string(dispatches.size()) +
                               " dispatches, the last of kernel " + dispatches.back().kernel->name);
    if (trace()) {
        wait(commands);
        const auto ended = Trace::Clock::now();
        std::vector<DispatchTime> times{{begin_ns, to_ns(ended)}};
        if (timestamps_) times = timestamps_->times();
        share_cpu(times, process_cpu_ns() - cpu_before);
        trace_dispatches(dispatches, times, ended);
    }
    count(dispatches);
    return commands;
}

std::string VulkanDevice::time_dispatches() {
    const std::uint32_t bits = timestamp_bits(context_->physical, context_->queue_family);
    if (bits > 0) {
        timestamps_.emplace(*context_, bits);
        return "its own clock";
    }
    options_.dispatches_per_submit = 1;
    return "the host's clock, one by one: the queue writes no timestamps";
}

std::unique_ptr<Running> VulkanDevice::begin(std::vector<Dispatch> batch, bool) {
    // All that can be wrong with a batch is found before any of it runs.
    for (const Dispatch& dispatch : batch) kernel(*dispatch.kernel);
    auto running = std::make_unique<Batch>(*this);
    std::span<const Dispatch> left = batch;
    try {
        while (!left.empty()) {
            const std::size_t count =
                std::min<std::size_t>(left.size(), options_.dispatches_per_submit);
            running->parts.push_back(begin_part(left.first(count)));
            left = left.subspan(count);
        }
    } catch (const Error&) {
        vkQueueWaitIdle(context_->queue);
        throw;
    }
    if (trace()) return nullptr;
    return running;
}

std::unique_ptr<Device> open_vulkan() {
    return std::make_unique<VulkanDevice>(open_vulkan_context());
}

std::shared_ptr<Device> adopt_vulkan(const VulkanHandles& handles) {
    auto given = std::make_unique<VulkanContext>();
    given->instance = static_cast<VkInstance>(handles.instance);
    given->physical = static_cast<VkPhysicalDevice>(handles.physical_device);
    given->device = static_cast<VkDevice>(handles.device);
    given->queue = static_cast<VkQueue>(handles.queue);
    given->queue_family = handles.queue_family;
    if (!given->instance || !given->physical || !given->device || !given->queue) {
        throw Error(ErrorKind::device,
                    "adopt_vulkan needs an instance, a physical device, a device and a queue, none "
                    "of them null");
    }
    if (const std::string problem = vulkan_problem(given->physical); !problem.empty()) {
        throw Error(ErrorKind::device, "adopt_vulkan: the device can't be used: " + problem);
    }
    if (!family_computes(given->physical, given->queue_family)) {
        throw Error(ErrorKind::device, "adopt_vulkan: queue family " +
                                           std::to_string(given->queue_family) +
                                           " does not compute; give a queue of one that does");
    }
    return std::make_shared<VulkanDevice>(std::move(given));
}

}  // namespace topple::device
