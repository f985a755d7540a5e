// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "topple/parse.h"

namespace topple::cli {

// Adds --max-memory, which sets bytes. What it does is `purpose`; how sizes are written is added.
void add_max_memory_option(CLI::App& app, std::uint64_t& bytes, const std::string& purpose);

// From now on the system gives this process no more than what a parse of the input may take, so
// that what grows between two looks at it ends, too, as memory that ran out.
void keep_to_budget(const std::string& input, const ParseOptions& options);

}  // namespace topple::cli
