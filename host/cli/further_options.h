// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

namespace topple::cli {

// What is added to the command from here on is listed by its --help-all only, so that its --help
// fits a screen.
void further_options(CLI::App& command);

// Has --help leave them out, and say so.
void list_them_apart(CLI::App& app);

}  // namespace topple::cli
