// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "perf/kernels/measure.h"

// Cases of kernels on every backend, with the probes beside them.
namespace topple::perf {

// Whether a filter is part of the name; or there is none.
bool wanted(const std::vector<std::string>& filters, const std::string& name);

// Throws Error(usage) where a filter is part of none of the names.
void check_filters(const std::vector<std::string>& filters, const std::vector<std::string>& names);

// Opens the backends, in this order; of those not named (none, or "all") each that can be used, and
// says which is skipped, and why. Throws Error: usage (an unknown backend), device (one that was
// named can't be used).
void each_backend(const std::vector<std::string>& names, unsigned threads,
                  const std::function<void(const std::shared_ptr<device::Device>&)>& each);

// Those cases that are wanted; with `probed` the probes, too, which are the yardstick of all.
std::vector<Result> measure_cases(device::Device& device, std::span<const Case> cases,
                                  const std::vector<std::string>& filters, bool probed,
                                  const MeasureOptions& options);

// Every backend must have computed the same: says on stderr where not.
bool hashes_agree(const std::vector<Result>& results);

}  // namespace topple::perf
