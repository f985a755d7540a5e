// SPDX-License-Identifier: MIT
#include "perf/profile.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>

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

// Closes a stage where the next one begins.
class Profiler {
  public:
    explicit Profiler(const device::Device& device) : device_(device) {}
    void begin(const std::string& stage) {
        // A stage tells of itself more than once.
        if (open_ && stages_.back().name == stage) return;
        end();
        open_ = true;
        stages_.push_back({stage, {}, device_.counters(), usage().touched_bytes, 0});
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
    const std::vector<StageProfile>& stages() const { return stages_; }

  private:
    const device::Device& device_;
    std::vector<StageProfile> stages_;
    Stopwatch watch_;
    bool open_ = false;
};

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
            "%-18s %8.2f %8.2f %6.2f %5.1f %% %10.0f %8.0f %10llu %8llu %9.1f %9.1f %10.1f\n",
            s.name.c_str(), s.span.wall_s, s.span.cpu_s,
            s.span.wall_s > 0 ? s.span.cpu_s / s.span.wall_s : 0, 100 * share,
            static_cast<double>(s.touched_bytes) / mega, static_cast<double>(s.peak_bytes) / mega,
            static_cast<unsigned long long>(s.counters.dispatches),
            static_cast<unsigned long long>(s.counters.submits),
            static_cast<double>(s.counters.bytes_written) / mega,
            static_cast<double>(s.counters.bytes_read) / mega,
            static_cast<double>(s.counters.bytes_bound) / mega);
    };
    std::printf("%-18s %8s %8s %6s %7s %10s %8s %10s %8s %9s %9s %10s\n", "stage", "wall s",
                "cpu s", "cores", "share", "touched MB", "peak MB", "dispatches", "submits",
                "to dev MB", "back MB", "bound MB");
    StageProfile all;
    all.name = "all";
    for (const StageProfile& s : stages) {
        all.span.wall_s += s.span.wall_s;
        all.span.cpu_s += s.span.cpu_s;
        all.touched_bytes += s.touched_bytes;
        all.peak_bytes = std::max(all.peak_bytes, s.peak_bytes);
        all.counters.dispatches += s.counters.dispatches;
        all.counters.submits += s.counters.submits;
        all.counters.bytes_written += s.counters.bytes_written;
        all.counters.bytes_read += s.counters.bytes_read;
        all.counters.bytes_bound += s.counters.bytes_bound;
    }
    for (const StageProfile& s : stages)
        line(s, all.span.wall_s > 0 ? s.span.wall_s / all.span.wall_s : 0);
    line(all, 1);
}

}  // namespace topple::perf
