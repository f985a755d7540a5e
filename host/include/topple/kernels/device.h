// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "topple/device.h"
#include "topple/error.h"
#include "topple/kernels/kernel.h"

// The whole device abstraction: a Device allocates Memory and runs lists of Dispatches. The typed
// faces that the rest of the host uses are Buffer<T> (buffer.h) and Queue (queue.h).
// Nothing here is global: every object belongs to the Device that made it, and a Device may be used
// from one thread at a time (InUse).
namespace topple {
class ThreadPool;
}

namespace topple::device {

class Trace;
struct DispatchTime;

// Offsets of bound ranges are multiples of this, on every backend. Vulkan asks for 256 at most,
// some OpenCL GPUs for 512.
inline constexpr std::uint64_t slice_alignment = 512;

class Device;

// What allocate() throws where a buffer is larger than the device has memory for, or lends at once.
class OutOfMemory : public Error {
  public:
    using Error::Error;
};

// One allocation of a device. Owned by whoever holds it; must not outlive its Device.
class Memory {
  public:
    Memory(const Device& device, std::uint64_t bytes, std::string name)
        : device_(device), bytes_(bytes), name_(std::move(name)) {}
    virtual ~Memory() = default;
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    const Device& device() const { return device_; }
    std::uint64_t bytes() const { return bytes_; }
    const std::string& name() const { return name_; }
    // Where the host may read and write the memory in place between runs, without a copy; null
    // where the device's memory is not the host's.
    virtual std::byte* host_address() = 0;
    // The same, null also where that would take a call of the driver first.
    virtual std::byte* in_place() { return host_address(); }

  private:
    const Device& device_;
    std::uint64_t bytes_;
    std::string name_;
};

struct BoundRange {
    Memory* memory = nullptr;
    std::uint64_t offset = 0;  // bytes, a multiple of slice_alignment
    std::uint64_t bytes = 0;
};

// `groups` work-groups of one kernel. Parameters are copied in (at most 128 bytes).
struct Dispatch {
    const KernelSource* kernel = nullptr;
    std::uint64_t groups = 0;
    std::vector<BoundRange> ranges;
    std::vector<std::byte> params;
};

// Counts that don't depend on the machine's speed: they can be gated exactly.
struct Counters {
    std::uint64_t dispatches = 0, submits = 0, kernel_builds = 0;
    std::uint64_t bytes_written = 0, bytes_read = 0;  // host to device, device to host
    std::uint64_t bytes_bound = 0;  // ranges that the dispatches bound: each in or out once
};

class Device {
  public:
    Device();
    virtual ~Device();
    const DeviceInfo& info() const { return info_; }
    Counters counters() const;

    // At least one byte is allocated, so that an empty array still has something to bind.
    // Throws OutOfMemory, or the driver's Error(device), naming the buffer and its size.
    virtual std::unique_ptr<Memory> allocate(std::uint64_t bytes, const std::string& name) = 0;
    void write(Memory& to, std::uint64_t offset, std::span<const std::byte> from);
    void read(Memory& from, std::uint64_t offset, std::span<std::byte> to);
    void fill(Memory& memory, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word);

    // Runs the dispatches in order, each seeing what the ones before it wrote, and waits once.
    // Throws Error(device) with the kernel's name and the driver's message.
    virtual void run(std::span<const Dispatch> dispatches) = 0;

    // Builds a kernel ahead of its first use, so that timings don't contain it.
    virtual void prepare(const KernelSource& kernel) = 0;

    // Threads for what the host does beside the device; the native backend's own, else one per
    // core.
    virtual ThreadPool& threads();

    std::uint32_t items_per_lane(const KernelSource& kernel) const;

    // Records what it does from now on; TOPPLE_TRACE has every device do so.
    void record(std::shared_ptr<Trace> trace);
    Trace* trace() const { return trace_.get(); }  // null where nothing is recorded
    // Whether kernels run in their checked forms: TOPPLE_CHECK=bounds.
    bool checks_bounds() const { return checks_bounds_; }

  protected:
    // write(), read() and fill() of memory that is not in place.
    virtual void send(Memory&, std::uint64_t, std::span<const std::byte>) {}
    virtual void fetch(Memory&, std::uint64_t, std::span<std::byte>) {}
    virtual void fill_apart(Memory&, std::uint64_t, std::uint64_t, std::uint32_t) {}
    // Has dispatches timed from now on, and says by which clock.
    virtual std::string time_dispatches() { return "the host's clock"; }
    // The times of a batch that has just ended, by any clock: it is set by the last one's end.
    void trace_dispatches(std::span<const Dispatch> dispatches, std::span<const DispatchTime> times,
                          std::chrono::steady_clock::time_point ended);
    // Books a batch that was run.
    void count(std::span<const Dispatch> dispatches);
    // As the kind of memory that this device makes. Throws Error(device) where it is another's.
    template <class Own>
    Own& own(Memory& memory) const {
        check_own(memory);
        return static_cast<Own&>(memory);
    }
    void check_own(const Memory& memory) const;
    // Throws OutOfMemory where a GPU's, or its driver's, limit is below that.
    void check_allocation(std::uint64_t bytes, const std::string& name) const;

    DeviceInfo info_;
    bool as_gpu_ = false;  // kernels take the form for real GPUs
    // As Counters: what uses the device may go on beside who reads them.
    struct {
        std::atomic<std::uint64_t> dispatches = 0, submits = 0, kernel_builds = 0,
                                   bytes_written = 0, bytes_read = 0, bytes_bound = 0;
    } counters_;

  private:
    friend class InUse;
    void copy(std::byte* to, const std::byte* from, std::uint64_t bytes);
    std::unique_ptr<ThreadPool> threads_;  // made when first asked for
    std::shared_ptr<Trace> trace_;
    std::uint32_t trace_track_ = 0;  // of the dispatches
    bool checks_bounds_;
    std::atomic<bool> in_use_{false};
};

// The forms in which a kernel runs: each backend's own, and that of real GPUs on whatever device
// there is for Vulkan. A kernel gives the same bits in all of them, so tests run each.
inline constexpr std::array forms{"native", "opencl", "vulkan", "vulkan_as_gpu"};
// Opens the device of one of them, or of vulkan_small_bindings, where an array takes several
// bindings from a megabyte on. Throws Error as open_device() does.
std::shared_ptr<Device> open_form(const std::string& form);

// Lives while a public function uses a device. Throws Error(usage) where another one does, on
// another thread or further up on this one.
class InUse {
  public:
    explicit InUse(Device& device);
    ~InUse();
    InUse(const InUse&) = delete;
    InUse& operator=(const InUse&) = delete;

  private:
    Device& device_;
};

}  // namespace topple::device
