// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include "topple/export.h"

namespace topple::cli {

// Adds an option for each format, which sets its path.
void add_export_options(CLI::App& app, ExportOptions& options);

// Whether one was given.
bool wants_export(const ExportOptions& options);

// What was made, in a few lines.
void print_export(const ExportSummary& summary);

}  // namespace topple::cli
