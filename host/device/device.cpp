// SPDX-License-Identifier: MIT
#include "device/device.h"

#include "core/thread_pool.h"
#include "device/queue.h"
#include "topple/error.h"

namespace topple::device {

const char* to_string(Backend backend) {
    switch (backend) {
        case Backend::native:
            return "native";
        case Backend::opencl:
            return "opencl";
        case Backend::vulkan:
            return "vulkan";
    }
    return "?";
}

const DeviceInfo& describe(const Device& device) {
    return device.info();
}

InUse::InUse(Device& device) : device_(device) {
    if (device.in_use_.exchange(true))
        throw Error(ErrorKind::usage,
                    "the device is in use by another parse or stage; open one for each thread");
}

InUse::~InUse() {
    device_.in_use_ = false;
}

Device::Device() = default;
Device::~Device() = default;

ThreadPool& Device::threads() {
    if (!threads_) threads_ = std::make_unique<ThreadPool>(0);
    return *threads_;
}

std::uint32_t Device::items_per_lane(const KernelSource& kernel) const {
    if (as_gpu_) return kernel.items_gpu;
    switch (info_.backend) {
        case Backend::native:
            return kernel.items_native;
        case Backend::opencl:
            return kernel.items_opencl;
        case Backend::vulkan:
            return kernel.items_vulkan;
    }
    return 1;
}

Counters Device::counters() const {
    return {counters_.dispatches,    counters_.submits,    counters_.kernel_builds,
            counters_.bytes_written, counters_.bytes_read, counters_.bytes_bound};
}

void Device::count(std::span<const Dispatch> dispatches) {
    counters_.dispatches += dispatches.size();
    ++counters_.submits;
    std::uint64_t bound = 0;
    for (const Dispatch& dispatch : dispatches) {
        for (const BoundRange& range : dispatch.ranges) bound += range.bytes;
    }
    counters_.bytes_bound += bound;
}

std::uint64_t Queue::groups_for(const KernelSource& kernel, std::uint64_t count) const {
    if (kernel.per_group) return count;
    const std::uint64_t per_group =
        std::uint64_t{kernel.group_size} * device_.items_per_lane(kernel);
    return (count + per_group - 1) / per_group;
}

void Queue::check(const Dispatch& dispatch) const {
    const KernelSource& kernel = *dispatch.kernel;
    const std::string where = std::string("kernel ") + kernel.name;
    for (std::size_t i = 0; i < dispatch.ranges.size(); ++i) {
        if (!dispatch.ranges[i].memory) {
            throw Error(ErrorKind::device, where + ": binding " + kernel.bindings[i].name +
                                               " is given a Buffer that was never allocated");
        }
        if (dispatch.ranges[i].bytes > device_.info().limits.max_binding_bytes) {
            throw Error(ErrorKind::device,
                        where + ": binding " + kernel.bindings[i].name + " spans " +
                            std::to_string(dispatch.ranges[i].bytes) + " bytes, more than the " +
                            std::to_string(device_.info().limits.max_binding_bytes) + " that " +
                            device_.info().name + " can bind; dispatch it in tiles");
        }
    }
    // Work-group and element indices are 32-bit in the kernels.
    const std::uint64_t items =
        dispatch.groups * kernel.group_size * device_.items_per_lane(kernel);
    if (items > 0xffffffffULL) {
        throw Error(ErrorKind::device, where + ": " + std::to_string(items) +
                                           " work-items exceed 2^32; dispatch it in tiles");
    }
}

void Queue::run() {
    if (dispatches_.empty()) return;
    // Taken out first: a failed run must not leave its dispatches behind for the next one.
    const std::vector<Dispatch> batch = std::move(dispatches_);
    dispatches_.clear();
    device_.run(batch);
}

}  // namespace topple::device
