// SPDX-License-Identifier: MIT
#include "topple/kernels/device.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "core/thread_pool.h"
#include "device/bounds_check.h"
#include "device/timeline.h"
#include "device/trace.h"
#include "topple/error.h"
#include "topple/kernels/queue.h"

namespace topple::device {

const char* to_string(Backend backend) {
    constexpr std::array names{"native", "opencl", "vulkan"};
    return names.at(static_cast<std::size_t>(backend));
}

namespace {

std::uint64_t bytes_bound(const Dispatch& dispatch) {
    std::uint64_t bytes = 0;
    for (const BoundRange& range : dispatch.ranges) bytes += range.bytes;
    return bytes;
}

}  // namespace

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

Device::Device() : timeline_(std::make_unique<Timeline>()), checks_bounds_(bounds_check_wanted()) {}
Device::~Device() = default;

void Device::settle() noexcept {
    while (timeline_->in_flight()) {
        try {
            timeline_->finish_all();
        } catch (...) {  // from a poll: the batches go on all the same
        }
    }
    timeline_->pool().limit(0);
    trim();
}

bool Device::in_flight() const {
    return timeline_->in_flight();
}

void Device::pool_memory() {
    constexpr std::uint64_t most = 256u << 20;
    timeline_->pool().limit(std::min(most, info_.limits.memory_bytes / 8));
}

void Device::trim() {
    timeline_->pool().trim();
}

void GiveBack::operator()(Memory* memory) const noexcept {
    device->give_back(std::unique_ptr<Memory>(memory));
}

void Device::give_back(std::unique_ptr<Memory> memory) noexcept {
    try {
        timeline_->give_back(std::move(memory));
    } catch (...) {  // from a poll, which the next one tells again
    }
}

MemoryPtr Device::allocate(std::uint64_t bytes, const std::string& name) {
    check_allocation(bytes, name);
    const std::uint64_t capacity = std::min(std::max(bytes, info_.limits.max_allocation_bytes),
                                            timeline_->pool().capacity_for(bytes));
    std::unique_ptr<Memory> memory = timeline_->pool().take(capacity);
    if (!memory) {
        try {
            memory = make_memory(capacity, name);
        } catch (const Error&) {
            timeline_->finish_all();  // what is given back in flight is in the way, too
            trim();
            memory = make_memory(capacity, name);
        }
    }
    memory->bytes_ = bytes;
    memory->name_ = name;
    memory->capacity_ = capacity;
    memory->batch_ = 0;
    return {memory.release(), {this}};
}

ThreadPool& Device::threads() {
    if (!threads_) threads_ = std::make_unique<ThreadPool>(0);
    return *threads_;
}

std::uint32_t Device::items_per_lane(const KernelSource& kernel) const {
    if (as_gpu_) return kernel.items_gpu;
    const std::array items{kernel.items_native, kernel.items_opencl, kernel.items_vulkan};
    return items.at(static_cast<std::size_t>(info_.backend));
}

Counters Device::counters() const {
    return {counters_.dispatches,    counters_.submits,    counters_.kernel_builds,
            counters_.bytes_written, counters_.bytes_read, counters_.bytes_bound,
            counters_.waits};
}

void Device::record(std::shared_ptr<Trace> trace) {
    if (!trace) return;
    trace_ = std::move(trace);
    trace_track_ = trace_->add_track(info_.name + " (" + to_string(info_.backend) + "), by " +
                                     time_dispatches());
}

void Device::trace_dispatches(std::span<const Dispatch> dispatches,
                              std::span<const DispatchTime> times, Trace::Clock::time_point ended) {
    for (std::size_t d = 0; d < times.size(); ++d) {
        const auto at = [&](std::int64_t ns) {
            return ended - std::chrono::nanoseconds(times.back().end_ns - ns);
        };
        trace_->add({"dispatch",
                     dispatches[d].kernel->name,
                     trace_track_,
                     at(times[d].begin_ns),
                     at(times[d].end_ns),
                     {{"groups", dispatches[d].groups},
                      {"bytes", bytes_bound(dispatches[d])},
                      {"cpu_ns", times[d].cpu_ns}}});
    }
}

void Device::count(std::span<const Dispatch> dispatches) {
    counters_.dispatches += dispatches.size();
    ++counters_.submits;
    std::uint64_t bound = 0;
    for (const Dispatch& dispatch : dispatches) bound += bytes_bound(dispatch);
    counters_.bytes_bound += bound;
}

void Device::copy(std::byte* to, const std::byte* from, std::uint64_t bytes) {
    // More is shared out: memory that is touched first has to be cleared.
    constexpr std::uint64_t at_once = 2u << 20;
    threads().run(bytes, at_once, [&](std::uint64_t first, std::uint64_t last) {
        std::memcpy(to + first, from + first, last - first);
    });
}

void Device::write(Memory& to, std::uint64_t offset, std::span<const std::byte> from) {
    check_own(to);
    wait(to.batch_);
    const TraceSpan span(trace(), "write", to.name(), {{"bytes", from.size()}});
    if (std::byte* const address = to.in_place())
        copy(address + offset, from.data(), from.size());
    else
        send(to, offset, from);
    counters_.bytes_written += from.size();
}

void Device::read(Memory& from, std::uint64_t offset, std::span<std::byte> to) {
    check_own(from);
    wait(from.batch_);
    const TraceSpan span(trace(), "read", from.name(), {{"bytes", to.size()}});
    if (const std::byte* const address = from.in_place())
        copy(to.data(), address + offset, to.size());
    else
        fetch(from, offset, to);
    counters_.bytes_read += to.size();
}

void Device::fill(Memory& memory, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word) {
    check_own(memory);
    wait(memory.batch_);
    const TraceSpan span(trace(), "fill", memory.name(), {{"bytes", bytes}});
    std::byte* const address = memory.in_place();
    if (!address) return fill_apart(memory, offset, bytes, word);
    auto* first = reinterpret_cast<std::uint32_t*>(address + offset);
    std::fill(first, first + bytes / sizeof(word), word);
}

std::byte* Device::host_view(Memory& memory) {
    wait(memory.batch_);
    return memory.host_address();
}

Event Device::submit(std::vector<Dispatch> batch) {
    return start(std::move(batch), false);
}

void Device::run(std::vector<Dispatch> batch) {
    start(std::move(batch), true).wait();
}

Event Device::start(std::vector<Dispatch> batch, bool at_once) {
    if (batch.empty()) return {};
    const TraceSpan span(trace(), "batch", batch.back().kernel->name,
                         {{"dispatches", batch.size()}});
    for (const Dispatch& dispatch : batch)
        for (const BoundRange& range : dispatch.ranges) check_own(*range.memory);
    timeline_->ended(0);  // lets go of what has ended, where nobody waits
    auto checks = checks_bounds_ ? std::make_unique<BoundsCheck>(*this, batch) : nullptr;
    std::vector<Memory*> bound;
    for (const Dispatch& dispatch : batch)
        for (const BoundRange& range : dispatch.ranges) bound.push_back(range.memory);
    std::ranges::sort(bound);
    bound.erase(std::ranges::unique(bound).begin(), bound.end());
    return {*this, timeline_->begun(begin(std::move(batch), at_once), std::move(checks),
                                    std::move(bound))};
}

void Device::wait(std::uint64_t batch) {
    if (batch <= waited_) return;
    timeline_->finish(batch);
    waited_ = batch;
    ++counters_.waits;
    timeline_->throw_failure(batch);
}

void Event::wait() const {
    if (device_) device_->wait(batch_);
}

bool Event::done() const {
    return !device_ || device_->timeline_->ended(batch_);
}

void Device::check_own(const Memory& memory) const {
    if (&memory.device() != this)
        throw Error(ErrorKind::device,
                    "buffer " + memory.name() + " belongs to another device than " + info_.name);
}

void Device::check_allocation(std::uint64_t bytes, const std::string& name) const {
    if (bytes > info_.limits.max_allocation_bytes)
        throw OutOfMemory(ErrorKind::device, "buffer " + name + ": " + std::to_string(bytes) +
                                                 " bytes are more than the " +
                                                 std::to_string(info_.limits.max_allocation_bytes) +
                                                 " that " + info_.name +
                                                 " allocates at once, unlike the native backend");
}

void Queue::add(const KernelSource& kernel, std::uint64_t count, std::vector<BoundRange> ranges,
                std::span<const std::byte> params) {
    if (ranges.size() != kernel.bindings.size() || params.size() != kernel.params_bytes) {
        throw Error(ErrorKind::usage,
                    std::string("kernel ") + kernel.name + " takes " +
                        std::to_string(kernel.bindings.size()) + " buffers and " +
                        std::to_string(kernel.params_bytes) + " bytes of parameters, not " +
                        std::to_string(ranges.size()) + " and " + std::to_string(params.size()));
    }
    if (count == 0) return;
    Dispatch dispatch;
    dispatch.kernel = &kernel;
    dispatch.groups = groups_for(kernel, count);
    dispatch.ranges = std::move(ranges);
    dispatch.params.assign(params.begin(), params.end());
    check(dispatch);
    dispatches_.push_back(std::move(dispatch));
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

Event Queue::submit() {
    return device_.submit(take());
}

void Queue::run() {
    device_.run(take());
}

}  // namespace topple::device
