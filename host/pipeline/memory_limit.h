// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "topple/parse.h"

namespace topple {

// Where `what` needs more than ParseOptions::max_memory_bytes throws Error(input): "<what> 1.03
// GiB, more than the 1.02 GiB of ParseOptions::max_memory_bytes: allow that much, or <mend>".
void check_memory(const std::string& what, std::uint64_t need_bytes, const ParseOptions& options,
                  const std::string& mend);

}  // namespace topple
