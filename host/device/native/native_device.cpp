// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <new>
#include <string>

#include "core/thread_pool.h"
#include "device/devices.h"
#include "device/trace.h"
#include "topple/error.h"

namespace topple::device {
namespace {

constexpr std::size_t alignment = 64;  // a cache line, and the widest vector register

class NativeMemory final : public Memory {
  public:
    NativeMemory(const Device& device, std::uint64_t bytes, const std::string& name)
        : Memory(device, bytes, name) {
        const std::uint64_t padded =
            (std::max<std::uint64_t>(bytes, 1) + alignment - 1) / alignment * alignment;
        data_ = static_cast<std::byte*>(std::aligned_alloc(alignment, padded));
        if (!data_) {
            // Not of the kind device: that can be used, but the scan is too large for it.
            throw OutOfMemory(ErrorKind::input, "buffer " + name + ": the system has no " +
                                                    std::to_string(bytes) + " bytes left");
        }
    }
    ~NativeMemory() override { std::free(data_); }
    std::byte* host_address() override { return data_; }

  private:
    std::byte* data_;
};

std::string cpu_name() {
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);) {
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    }
    return "CPU";
}

constexpr std::uint64_t least_items = 4096;  // 1 to 100 microseconds of work

class NativeDevice final : public Device {
  public:
    explicit NativeDevice(unsigned threads) : pool_(threads) {
        info_.backend = Backend::native;
        info_.name = cpu_name();
        info_.driver = std::to_string(pool_.threads()) + " threads";
        const std::uint64_t memory = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                                     static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
        info_.limits = {memory, memory, memory, 1024, 1u << 20};
        record(Trace::of_environment());
    }

    std::unique_ptr<Memory> allocate(std::uint64_t bytes, const std::string& name) override {
        if (bytes > info_.limits.max_allocation_bytes) {
            throw OutOfMemory(ErrorKind::device,
                              "buffer " + name + ": " + std::to_string(bytes) +
                                  " bytes are more than the machine's memory of " +
                                  std::to_string(info_.limits.memory_bytes) + " bytes");
        }
        return std::make_unique<NativeMemory>(*this, bytes, name);
    }
    void prepare(const KernelSource&) override {}
    ThreadPool& threads() override { return pool_; }

    void run(std::span<const Dispatch> dispatches) override {
        std::vector<DispatchTime> times;
        for (const Dispatch& dispatch : dispatches) {
            const std::int64_t begin_ns = trace() ? to_ns(Trace::Clock::now()) : 0;
            std::atomic<std::uint64_t> cpu_ns = 0;
            std::vector<void*> addresses;
            addresses.reserve(dispatch.ranges.size());
            for (const BoundRange& range : dispatch.ranges) {
                addresses.push_back(address(*range.memory) + range.offset);
            }
            const NativeEntry entry = best_entry(dispatch.kernel->native);
            const NativeArgs args{addresses.data(), dispatch.params.data()};
            // Some chunks per thread, so that an uneven load evens out; none so small that waking
            // a thread takes longer.
            const std::uint64_t of_group =
                std::uint64_t{dispatch.kernel->group_size} * dispatch.kernel->items_native;
            const std::uint64_t least =
                dispatch.kernel->per_group ? 1 : std::max<std::uint64_t>(1, least_items / of_group);
            const std::uint64_t chunk =
                std::max(least, dispatch.groups / (std::uint64_t{pool_.threads()} * 16) + 1);
            pool_.run(dispatch.groups, chunk, [&](std::uint64_t first, std::uint64_t last) {
                const std::uint64_t before = trace() ? thread_cpu_ns() : 0;
                entry(args, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
                if (trace()) cpu_ns += thread_cpu_ns() - before;
            });
            if (trace()) times.push_back({begin_ns, to_ns(Trace::Clock::now()), cpu_ns});
        }
        if (!times.empty())
            trace_dispatches(
                dispatches, times,
                Trace::Clock::time_point(std::chrono::nanoseconds(times.back().end_ns)));
        count(dispatches);
    }

  private:
    std::byte* address(Memory& memory) const {
        check_own(memory);
        return memory.host_address();
    }

    ThreadPool pool_;
};

}  // namespace

NativeEntry best_entry(const NativeEntries& entries) {
#if defined(__x86_64__)
    if (entries.avx512 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512cd")) {
        return entries.avx512;
    }
    if (entries.avx2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
        __builtin_cpu_supports("bmi2")) {
        return entries.avx2;
    }
#endif
    return entries.baseline;
}

std::unique_ptr<Device> open_native(unsigned threads) {
    if (threads > ThreadPool::most_threads) {
        throw Error(ErrorKind::usage, "threads (--threads) " + std::to_string(threads) +
                                          ": at most " + std::to_string(ThreadPool::most_threads) +
                                          " are of use; leave it out for one per core");
    }
    return std::make_unique<NativeDevice>(threads);
}

}  // namespace topple::device
