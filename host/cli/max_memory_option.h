// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace topple::cli {

// Adds --max-memory, which sets bytes. What it does is `purpose`; how sizes are written is added.
void add_max_memory_option(CLI::App& app, std::uint64_t& bytes, const std::string& purpose);

}  // namespace topple::cli
