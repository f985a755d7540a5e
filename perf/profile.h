// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "perf/kernels/stopwatch.h"
#include "topple/kernels/device.h"

namespace topple::perf {

// What one stage of a parse took.
struct StageProfile {
    std::string name;
    Span span;
    device::Counters counters;
    // Pages of memory that it touched first, in bytes: what it allocated anew.
    std::uint64_t touched_bytes = 0;
    std::uint64_t peak_bytes = 0;  // of the process until its end
};

// Parses an input and writes all outputs to a folder of its own, which it removes: stage by stage,
// with what lies between two stages as part of the earlier one. Throws as parse() does.
std::vector<StageProfile> profile(const std::shared_ptr<device::Device>& device,
                                  const std::filesystem::path& input);

void print_profile(const std::vector<StageProfile>& stages);

}  // namespace topple::perf
