// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/scale_checks.h"
#include "topple/parse.h"

namespace topple {

// "--max-memory" or "max_memory_bytes": what a limit of memory is called where such a scan is
// given.
const char* memory_option(ScanOrigin origin);

// Where `what` needs more than ParseOptions::max_memory_bytes throws Error(input): "<what> 1.03
// GiB, more than the 1.02 GiB of --max-memory: allow that much, or <mend>".
void check_memory(const std::string& what, std::uint64_t need_bytes, const ParseOptions& options,
                  ScanOrigin origin, const std::string& mend);

}  // namespace topple
