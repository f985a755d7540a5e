// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "perf/kernels/measure.h"

namespace topple::perf {

void print_results(const std::vector<Result>& results);

// All samples, counts and hashes as JSON; and one line per case.
std::string json_text(const std::vector<Result>& results);
std::string csv_text(const std::vector<Result>& results);

}  // namespace topple::perf
