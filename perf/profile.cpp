// SPDX-License-Identifier: MIT
#include "perf/profile.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "device/trace.h"
#include "lab/temporary_folder.h"
#include "perf/kernels/measure.h"
#include "topple/parse.h"

namespace topple::perf {
namespace {

struct Usage {
    std::uint64_t touched_bytes = 0, peak_bytes = 0;
};

Usage usage() {
    rusage now{};
    getrusage(RUSAGE_SELF, &now);
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    return {static_cast<std::uint64_t>(now.ru_minflt) * page,
            static_cast<std::uint64_t>(now.ru_maxrss) * 1024};
}

using Clock = device::Trace::Clock;
using Event = device::Trace::Event;

double seconds(Clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

std::uint64_t number(const Event& event, std::string_view name) {
    for (const auto& [key, value] : event.numbers)
        if (key == name) return value;
    return 0;
}

// What of the events, in the order in which they began, lies between begin and end.
void add_events(StageProfile& stage, const std::vector<Event>& events, Clock::time_point begin,
                Clock::time_point end) {
    Clock::time_point covered = begin;  // by dispatches, of which several may run at a time
    for (const Event& event : events) {
        const std::string_view kind = event.kind;
        if (kind == "wait")
            stage.waits_s +=
                std::max(0.0, seconds(std::min(event.end, end) - std::max(event.begin, begin)));
        if (kind != "dispatch") continue;
        stage.kernels_s +=
            std::max(0.0, seconds(std::min(event.end, end) - std::max(event.begin, covered)));
        covered = std::max(covered, event.end);
        if (event.begin < begin || event.begin >= end) continue;
        KernelProfile& kernel = stage.kernels[event.name];
        ++kernel.dispatches;
        kernel.bytes_bound += number(event, "bytes");
        kernel.device_s += seconds(event.end - event.begin);
        kernel.cpu_s += 1e-9 * static_cast<double>(number(event, "cpu_ns"));
    }
    for (const auto& [name, kernel] : stage.kernels) stage.kernels_cpu_s += kernel.cpu_s;
}

// Closes a stage where the next one begins.
class Profiler {
  public:
    explicit Profiler(device::Device& device) : device_(device) {
        if (!device.trace()) device.record(std::make_shared<device::Trace>());
    }
    void begin(const std::string& stage) {
        // A stage tells of itself more than once.
        if (open_ && stages_.back().name == stage) return;
        end();
        open_ = true;
        stages_.push_back({stage, {}, device_.counters(), usage().touched_bytes, 0});
        begins_.push_back(Clock::now());
        watch_ = Stopwatch();
    }
    void end() {
        if (!open_) return;
        StageProfile& last = stages_.back();
        last.span = watch_.elapsed();
        last.counters = device_.counters() - last.counters;
        const Usage now = usage();
        last.touched_bytes = now.touched_bytes - last.touched_bytes;
        last.peak_bytes = now.peak_bytes;
        open_ = false;
    }
    // All stages, the last of which has ended.
    std::vector<StageProfile> stages() {
        begins_.push_back(Clock::now());
        std::vector<Event> events = device_.trace()->events();
        std::ranges::stable_sort(events, {}, &Event::begin);
        for (std::size_t s = 0; s < stages_.size(); ++s)
            add_events(stages_[s], events, begins_[s], begins_[s + 1]);
        return std::move(stages_);
    }

  private:
    device::Device& device_;
    std::vector<StageProfile> stages_;
    std::vector<Clock::time_point> begins_;
    Stopwatch watch_;
    bool open_ = false;
};

double ratio(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

}  // namespace

std::vector<StageProfile> profile(const std::shared_ptr<device::Device>& device,
                                  const std::filesystem::path& input) {
    Profiler profiler(*device);
    ParseOptions options;
    options.device = device;
    options.progress = [&](const std::string& stage, double) { profiler.begin(stage); };
    const ParseResult result = parse(input, options);
    const scenes::TemporaryFolder folder("topple-profile");
    profiler.begin("output");
    write_outputs(result, folder.path() / "out");
    profiler.end();
    return profiler.stages();
}

void print_profile(const std::vector<StageProfile>& stages) {
    constexpr double mega = 1e6;
    const auto line = [&](const StageProfile& s, double share) {
        std::printf(
            "%-18s %8.2f %8.2f %6.2f %5.1f %% %9.2f %9.2f %8.2f %10.0f %8.0f %10llu %8llu %8llu "
            "%9.1f %9.1f %10.1f\n",
            s.name.c_str(), s.span.wall_s, s.span.cpu_s, ratio(s.span.cpu_s, s.span.wall_s),
            100 * share, s.kernels_s, s.kernels_cpu_s, s.waits_s,
            static_cast<double>(s.touched_bytes) / mega, static_cast<double>(s.peak_bytes) / mega,
            static_cast<unsigned long long>(s.counters.dispatches),
            static_cast<unsigned long long>(s.counters.submits),
            static_cast<unsigned long long>(s.counters.waits),
            static_cast<double>(s.counters.bytes_written) / mega,
            static_cast<double>(s.counters.bytes_read) / mega,
            static_cast<double>(s.counters.bytes_bound) / mega);
    };
    std::printf("%-18s %8s %8s %6s %7s %9s %9s %8s %10s %8s %10s %8s %8s %9s %9s %10s\n", "stage",
                "wall s", "cpu s", "cores", "share", "kernels s", "their cpu", "waits s",
                "touched MB", "peak MB", "dispatches", "submits", "waits", "to dev MB", "back MB",
                "bound MB");
    StageProfile all;
    all.name = "all";
    for (const StageProfile& s : stages) {
        all.span.wall_s += s.span.wall_s;
        all.span.cpu_s += s.span.cpu_s;
        all.touched_bytes += s.touched_bytes;
        all.peak_bytes = std::max(all.peak_bytes, s.peak_bytes);
        all.counters.dispatches += s.counters.dispatches;
        all.counters.submits += s.counters.submits;
        all.counters.waits += s.counters.waits;
        all.counters.bytes_written += s.counters.bytes_written;
        all.counters.bytes_read += s.counters.bytes_read;
        all.counters.bytes_bound += s.counters.bytes_bound;
        all.kernels_s += s.kernels_s;
        all.kernels_cpu_s += s.kernels_cpu_s;
        all.waits_s += s.waits_s;
    }
    for (const StageProfile& s : stages) line(s, ratio(s.span.wall_s, all.span.wall_s));
    line(all, 1);

    std::printf("\n%-18s %-20s %10s %9s %9s %10s\n", "stage", "kernel", "dispatches", "device s",
                "cpu s", "bound MB");
    for (const StageProfile& s : stages)
        for (const auto& [name, k] : s.kernels)
            std::printf("%-18s %-20s %10llu %9.3f %9.3f %10.1f\n", s.name.c_str(), name.c_str(),
                        static_cast<unsigned long long>(k.dispatches), k.device_s, k.cpu_s,
                        static_cast<double>(k.bytes_bound) / mega);
    std::printf("\nKernels ran in %.1f %% of the time, and took %.1f %% of the processor time.\n",
                100 * ratio(all.kernels_s, all.span.wall_s),
                100 * ratio(all.kernels_cpu_s, all.span.cpu_s));
}

}  // namespace topple::perf
