// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <string>

#include "cli/choice.h"
#include "cli/option_values.h"

// Options that several commands have.
namespace topple::cli {

// Metres in each.
inline const std::map<std::string, double>& units_of_length() {
    static const std::map<std::string, double> units{
        {"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};
    return units;
}

// --unit, which sets metres per unit of the input's coordinates.
inline void add_unit_option(CLI::App& app, double& unit_m) {
    app.add_option_function<std::string>(
           "--unit", [&unit_m](const std::string& unit) { unit_m = units_of_length().at(unit); },
           "Unit of a cloud's or mesh's coordinates: m, cm, mm, in or ft; the output is in metres")
        ->check(one_of({"m", "cm", "mm", "in", "ft"}))
        ->default_str("m");
}

// --no-isolate, which clears `isolate`.
inline void add_isolate_option(CLI::App& app, bool& isolate) {
    app.add_flag_function(
        "--no-isolate", [&isolate](std::int64_t) { isolate = false; },
        "Read meshes, OctoMaps and OpenVDB files in this process, not in one of its own with\n"
        "limits of memory and time: for large files that you trust");
}

// --max-memory, which sets bytes. What it does is `purpose`; how sizes are written is added.
inline void add_max_memory_option(CLI::App& app, std::uint64_t& bytes, const std::string& purpose) {
    app.add_option_function<std::string>(
        "--max-memory",
        [&bytes](const std::string& text) { bytes = parse_size("--max-memory", text); },
        purpose + "\n(4G and 4GiB are 4 * 1024^3 bytes, 4GB is 4 * 1000^3; so are M, K and T)");
}

}  // namespace topple::cli
