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

// The whole device abstraction: a Device allocates Memory and runs batches of Dispatches. The typed
// faces that the rest of the host uses are Buffer<T> (buffer.h) and Queue (queue.h).
// Nothing here is global: every object belongs to the Device that made it, and a Device may be used
// from one thread at a time (InUse).
namespace topple {
class ThreadPool;
}

namespace topple::device {

class Running;
class Timeline;
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

// One allocation of a device. Held by a MemoryPtr; must not outlive its Device.
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
    // Called when the last batch that binds it has ended, and when its holder lets go of it.
    virtual void batch_ended() {}
    virtual void given_back() {}

  private:
    friend class Device;
    friend class Timeline;
    friend class MemoryPool;
    const Device& device_;
    std::uint64_t bytes_;
    std::string name_;
    std::uint64_t capacity_ = 0;  // bytes allocated, not less than bytes_; 0: the caller's own
    std::uint64_t batch_ = 0;     // the last that binds it
};

// Gives memory back to its device: it lives on until no batch in flight binds it, and may then be
// what allocate() hands out next.
struct GiveBack {
    Device* device = nullptr;
    void operator()(Memory* memory) const noexcept;
};
using MemoryPtr = std::unique_ptr<Memory, GiveBack>;

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

// The end of a batch that a device was given, and so of all before it. Must not be asked once its
// Device is gone; may be forgotten.
class Event {
  public:
    Event() = default;  // of nothing
    // Throws as Device::submit() says.
    void wait() const;
    bool done() const;

  private:
    friend class Device;
    Event(Device& device, std::uint64_t batch) : device_(&device), batch_(batch) {}
    Device* device_ = nullptr;
    std::uint64_t batch_ = 0;
};

// Counts that don't depend on the machine's speed: they can be gated exactly.
struct Counters {
    std::uint64_t dispatches = 0, submits = 0, kernel_builds = 0;
    std::uint64_t bytes_written = 0, bytes_read = 0;  // host to device, device to host
    std::uint64_t bytes_bound = 0;  // ranges that the dispatches bound: each in or out once
    // Times that the host needed the end of a batch which it had not waited for yet, whether or not
    // that had come by then.
    std::uint64_t waits = 0;
};

class Device {
  public:
    Device();
    virtual ~Device();
    const DeviceInfo& info() const { return info_; }
    Counters counters() const;

    // What it holds is not specified. At least one byte is allocated, so that an empty array still
    // has something to bind. Throws OutOfMemory, or the driver's Error(device), naming the buffer
    // and its size.
    MemoryPtr allocate(std::uint64_t bytes, const std::string& name);
    // Lets go of the memory that is kept for allocate().
    void trim();

    // These wait for the last batch in flight that binds the memory, and throw its error, or that
    // of one before it, as Event::wait() does.
    void write(Memory& to, std::uint64_t offset, std::span<const std::byte> from);
    void read(Memory& from, std::uint64_t offset, std::span<std::byte> to);
    void fill(Memory& memory, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word);
    std::byte* host_view(Memory& memory);  // its host_address()

    // Begins a batch: its dispatches run in order, after all batches before it, each seeing what
    // the ones before it wrote. What is wrong with it beforehand is thrown at once; what goes wrong
    // later by the first wait for it or for a later batch, once: an Error(device) with the kernel's
    // name and the driver's message.
    Event submit(std::vector<Dispatch> batch);
    // The same, and waits.
    void run(std::vector<Dispatch> batch);

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
    virtual std::unique_ptr<Memory> make_memory(std::uint64_t bytes, const std::string& name) = 0;
    // Throws OutOfMemory where a limit of the device, or of its driver, is below that.
    virtual void check_allocation(std::uint64_t bytes, const std::string& name) const;
    // Begins a batch. at_once: the host waits for it next. Null where it has already ended.
    virtual std::unique_ptr<Running> begin(std::vector<Dispatch> batch, bool at_once) = 0;
    bool in_flight() const;  // whether there are batches that may not have ended
    // Keeps memory that is given back for allocate(), up to 256 MiB or an eighth of the device's.
    void pool_memory();
    // Each backend's destructor begins with this: no batch is in flight any more, no memory kept.
    void settle() noexcept;
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

    DeviceInfo info_;
    bool as_gpu_ = false;  // kernels take the form for real GPUs
    // As Counters: what uses the device may go on beside who reads them.
    struct {
        std::atomic<std::uint64_t> dispatches = 0, submits = 0, kernel_builds = 0,
                                   bytes_written = 0, bytes_read = 0, bytes_bound = 0, waits = 0;
    } counters_;

  private:
    friend class InUse;
    friend class Event;
    friend struct GiveBack;
    Event start(std::vector<Dispatch> batch, bool at_once);
    void wait(std::uint64_t batch);
    void give_back(std::unique_ptr<Memory> memory) noexcept;
    void copy(std::byte* to, const std::byte* from, std::uint64_t bytes);
    std::unique_ptr<Timeline> timeline_;
    std::uint64_t waited_ = 0;             // the last batch whose end the host has waited for
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
