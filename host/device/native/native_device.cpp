// SPDX-License-Identifier: MIT
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/thread_pool.h"
#include "device/devices.h"
#include "device/native/native_worker.h"
#include "device/trace.h"
#include "topple/error.h"

namespace topple::device {
namespace {

constexpr std::size_t alignment = 64;  // a cache line, and the widest vector register
// Of large buffers, which the system then fills by whole pages of this size, 512 times as few.
constexpr std::size_t huge_page = std::size_t{2} << 20, least_huge = 2 * huge_page;

// The system may leave it.
void ask_for_huge_pages([[maybe_unused]] void* data, [[maybe_unused]] std::uint64_t bytes) {
#ifdef MADV_HUGEPAGE
    madvise(data, bytes, MADV_HUGEPAGE);
#endif
}

class NativeMemory final : public Memory {
  public:
    NativeMemory(const Device& device, std::uint64_t bytes, const std::string& name)
        : Memory(device, bytes, name) {
        const std::uint64_t unit = bytes < least_huge ? alignment : huge_page;
        const std::uint64_t padded = (std::max<std::uint64_t>(bytes, 1) + unit - 1) / unit * unit;
        data_ = static_cast<std::byte*>(std::aligned_alloc(unit, padded));
        if (!data_) {
            // Not of the kind device: that can be used, but the scan is too large for it.
            throw OutOfMemory(ErrorKind::input, "buffer " + name + ": the system has no " +
                                                    std::to_string(bytes) + " bytes left");
        }
        if (unit == huge_page) ask_for_huge_pages(data_, padded);
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

// Groups that a thread takes at a time: some chunks per thread, so that an uneven load evens out;
// none so small that waking a thread takes longer.
std::uint64_t chunk_of(const Dispatch& dispatch, const ThreadPool& pool) {
    const KernelSource& kernel = *dispatch.kernel;
    const std::uint64_t of_group = std::uint64_t{kernel.group_size} * kernel.items_native;
    const std::uint64_t least =
        kernel.per_group ? 1 : std::max<std::uint64_t>(1, least_items / of_group);
    return std::max(least, dispatch.groups / (std::uint64_t{pool.threads()} * 16) + 1);
}

// A dispatch with the addresses of its ranges: the worker looks at no Memory, which is the host's.
struct Call {
    Dispatch dispatch;
    std::vector<void*> addresses;
};

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
    ~NativeDevice() override { settle(); }

    void prepare(const KernelSource&) override {}
    ThreadPool& threads() override { return pool_; }

  private:
    std::unique_ptr<Memory> make_memory(std::uint64_t bytes, const std::string& name) override {
        return std::make_unique<NativeMemory>(*this, bytes, name);
    }
    void check_allocation(std::uint64_t bytes, const std::string& name) const override {
        if (bytes <= info_.limits.max_allocation_bytes) return;
        throw OutOfMemory(ErrorKind::device, "buffer " + name + ": " + std::to_string(bytes) +
                                                 " bytes are more than the machine's memory of " +
                                                 std::to_string(info_.limits.memory_bytes) +
                                                 " bytes");
    }

    std::unique_ptr<Running> begin(std::vector<Dispatch> batch, bool at_once) override {
        count(batch);
        std::vector<Call> calls;
        for (Dispatch& dispatch : batch) {
            std::vector<void*> addresses;
            for (const BoundRange& range : dispatch.ranges)
                addresses.push_back(range.memory->host_address() + range.offset);
            calls.push_back({std::move(dispatch), std::move(addresses)});
        }
        if (!in_flight() && (at_once || runs_here(calls))) {
            run_calls(calls);
            return nullptr;
        }
        return worker_->add([this, calls = std::move(calls)] { run_calls(calls); });
    }

    // Whether a batch is better run by the host: it ends before another thread would wake, there is
    // no other thread, or a trace is to tell its time alone.
    bool runs_here(const std::vector<Call>& calls) {
        if (trace() || pool_.threads() == 1) return true;
        std::uint64_t items = 0;
        for (const auto& [dispatch, addresses] : calls) {
            if (dispatch.kernel->per_group) items += least_items;  // may be any amount of work
            items += dispatch.groups * dispatch.kernel->group_size * dispatch.kernel->items_native;
        }
        return items <= least_items || !has_worker();
    }

    bool has_worker() {
        if (worker_) return true;
        try {
            worker_.emplace(pool_);
        } catch (const std::system_error&) {  // the system has no more threads
        }
        return worker_.has_value();
    }

    void run_calls(const std::vector<Call>& calls) {
        if (trace()) return run_timed(calls);
        for (const Call& call : calls) run_call(call);
    }

    void run_call(const Call& call, std::atomic<std::uint64_t>* cpu_ns = nullptr) {
        const Dispatch& dispatch = call.dispatch;
        const NativeEntry entry = best_entry(dispatch.kernel->native);
        const NativeArgs args{call.addresses.data(), dispatch.params.data()};
        pool_.run(dispatch.groups, chunk_of(dispatch, pool_),
                  [&](std::uint64_t first, std::uint64_t last) {
                      const std::uint64_t before = cpu_ns ? thread_cpu_ns() : 0;
                      entry(args, static_cast<std::uint32_t>(first),
                            static_cast<std::uint32_t>(last));
                      if (cpu_ns) *cpu_ns += thread_cpu_ns() - before;
                  });
    }

    void run_timed(const std::vector<Call>& calls) {
        std::vector<Dispatch> dispatches;
        std::vector<DispatchTime> times;
        for (const Call& call : calls) {
            const std::int64_t begin_ns = to_ns(Trace::Clock::now());
            std::atomic<std::uint64_t> cpu_ns = 0;
            run_call(call, &cpu_ns);
            times.push_back({begin_ns, to_ns(Trace::Clock::now()), cpu_ns});
            dispatches.push_back(call.dispatch);
        }
        trace_dispatches(dispatches, times,
                         Trace::Clock::time_point(std::chrono::nanoseconds(times.back().end_ns)));
    }

    ThreadPool pool_;
    std::optional<NativeWorker> worker_;  // from the first batch that the host does not run
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
