// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "topple/kernels/device.h"

namespace topple::perf {

// Data-parallel primitives on `count` elements, beside the parallel algorithms of the standard
// library (TBB) on the native backend and Boost.Compute on OpenCL. Prints them, and gives whether
// all results are the same.
bool compare_primitives(device::Device& device, std::uint32_t count, unsigned runs);

// A peer's runs of one primitive: its best time, and what comes out first.
struct PeerRun {
    double seconds = 0;
    std::vector<std::uint32_t> out;
};

// Inputs of the primitives.
struct PrimitiveInput {
    std::vector<std::uint32_t> words, values, flags, ascending;
    std::vector<std::uint64_t> wide;
};

// Of one library; what it lacks is none.
struct PrimitivePeers {
    std::string library;
    std::optional<PeerRun> sort{}, sort_by_key{}, sort_wide_by_key{}, scan{}, compact{}, reduce{},
        segmented_sum{}, unique{};
};
PrimitivePeers standard_primitives(const PrimitiveInput& input, unsigned runs);
// None where Boost.Compute is not in this build.
std::optional<PrimitivePeers> boost_compute_primitives(const PrimitiveInput& input, unsigned runs);

}  // namespace topple::perf
