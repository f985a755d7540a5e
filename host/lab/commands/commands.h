// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "lab/scan/scan.h"

namespace topple::cli {

Command add_generate(CLI::App& app);
Command add_evaluate(CLI::App& app);
Command add_rate(CLI::App& app);

// Adds --furniture, which sets whether generated rooms are the varied ones.
void add_furniture(CLI::App& app, bool& varied);

// Adds --scan, which sets how a generated room is scanned.
CLI::Option* add_scan(CLI::App& app, scenes::ScanKind& kind);

}  // namespace topple::cli
