// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "perf/kernels/stopwatch.h"
#include "topple/kernel_testing/case.h"
#include "topple/kernels/device.h"

namespace topple::perf {

struct MeasureOptions {
    unsigned runs = 0;     // samples of each case; 0: as many as fit into `seconds`, 7 to 100
    double seconds = 1.0;  // for each case
    bool once = false;     // no sample but the first run, which builds the kernel, too
};

// Figures of one case on one backend, or of one stage of the pipeline.
struct Result {
    std::string backend, device, driver, name;
    bool gpu = false;  // the device is a real GPU: processor times do not tell its work
    Work work;
    std::vector<double> samples_s;      // wall time of one run each, in the order taken
    std::vector<double> samples_cpu_s;  // of all threads; empty for stages within a whole
    std::uint64_t hash = 0;
    device::Counters counters;  // of one run: what can be gated exactly
    double share = 0;           // of the roofline; 0 where there is none
    // What the roofline's least time comes from: "memory" | "arithmetic" | "divisions" | "gathers".
    const char* bound = "";

    void add(const Span& span, double runs = 1);
    double best() const;
    double best_cpu() const;  // 0 where there is none
    double median() const;
    double worst() const;
};

// One without samples, on this device.
Result named(const device::Device& device, std::string name, Work work);

// Adds the times of `runs` runs; the counts are those of the first.
void sample(device::Device& device, Result& result, unsigned runs,
            const std::function<void()>& run);

// What was counted from b to a.
device::Counters operator-(const device::Counters& a, const device::Counters& b);

// Runs the case once to warm up, then takes samples. Short runs are batched, several dispatches for
// each wait, so that a sample lasts at least 1 ms (where the case may repeat without a reset).
Result measure(device::Device& device, const Case& test, const MeasureOptions& options);

// Fills in share and bound: least time that the backend's own rates allow for the work, over the
// best time: its bandwidth (triad), its rates of multiply-adds, divisions and gathers. Needs the
// backend's four probes among the results.
void apply_roofline(std::vector<Result>& results);

}  // namespace topple::perf
