// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "perf/kernels/stopwatch.h"
#include "topple/kernels/device.h"

namespace topple::perf {

// What the dispatches of one kernel took, by the clock that traces have (device/trace.h).
struct KernelProfile {
    std::uint64_t dispatches = 0, bytes_bound = 0;
    double device_s = 0, cpu_s = 0;
};

// What one stage of a parse took.
struct StageProfile {
    std::string name;
    Span span;
    device::Counters counters;
    // Pages of memory that it touched first, in bytes: what it allocated anew.
    std::uint64_t touched_bytes = 0;
    std::uint64_t peak_bytes = 0;  // of the process until its end
    std::map<std::string, KernelProfile> kernels = {};
    // While any kernel ran; their processor time, by drivers what the process took during a batch;
    // and while the host waited for the device.
    double kernels_s = 0, kernels_cpu_s = 0, waits_s = 0;
};

// Parses an input and writes all outputs to a folder of its own, which it removes: stage by stage,
// with what lies between two stages as part of the earlier one. Throws as parse() does.
std::vector<StageProfile> profile(const std::shared_ptr<device::Device>& device,
                                  const std::filesystem::path& input);

void print_profile(const std::vector<StageProfile>& stages);

}  // namespace topple::perf
