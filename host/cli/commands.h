// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

// Each command adds its options to the parser and returns what runs it. A command's result is the
// program's exit code; errors leave it as topple::Error.
namespace topple::cli {

using Command = std::function<int()>;

Command add_parse(CLI::App& app);
Command add_devices(CLI::App& app);
Command add_generate(CLI::App& app);

}  // namespace topple::cli
