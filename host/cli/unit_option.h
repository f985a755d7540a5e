// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "cli/choice.h"

namespace topple::cli {

// --unit, which sets metres per unit of the input's coordinates.
inline void add_unit_option(CLI::App& app, double& unit_m) {
    static const std::map<std::string, double> units{
        {"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};
    app.add_option_function<std::string>(
           "--unit", [&unit_m](const std::string& unit) { unit_m = units.at(unit); },
           "Unit of a cloud's or mesh's coordinates: m, cm, mm, in or ft; the output is in metres")
        ->check(one_of({"m", "cm", "mm", "in", "ft"}))
        ->default_str("m");
}

}  // namespace topple::cli
