// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/choice.h"
#include "io/text.h"
#include "topple/crew.h"

// Each command adds its options to the parser and returns what runs it. A command's result is the
// program's exit code; errors leave it as topple::Error.
namespace topple::cli {

using Command = std::function<int()>;

// For options of unsigned type: the parser takes "-1" for 2^64 - 1. Returns what is wrong.
inline std::string whole_number(const std::string& text) {
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    const bool whole =
        !text.empty() && text.size() < 20 && std::all_of(text.begin(), text.end(), digit);
    return whole ? "" : text + ": expected a whole number from 0 to 10^19";
}

// The same for options that take numbers above 0.
inline std::string number_above_0(const std::string& text) {
    double value = 0;
    return io::parse_number(text, value) && value > 0 ? "" : text + ": expected a number above 0";
}

// How a parse is one process' part of a job of several. Alone: nothing of it.
struct Team {
    std::shared_ptr<Crew> crew;
    bool leads = true;
    unsigned threads = 0;           // unless --threads says otherwise; 0: all cores
    std::function<bool()> stopped;  // polled; true: another process has failed
};
// typed: the whole command, which the report shows for parsing once more.
inline constexpr const char* parse_purpose = "Parse a scan into solid objects, supports and risks";
Command add_parse(CLI::App& app, std::vector<std::string> typed, const Team& team = {});
Command add_devices(CLI::App& app);
Command add_estimate(CLI::App& app);
Command add_landscape(CLI::App& app);
Command add_ask(CLI::App& app);
Command add_export(CLI::App& app);
Command add_verify(CLI::App& app);
Command add_view(CLI::App& app);
Command add_live(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_perf(CLI::App& app);
// Those of topple-lab, which then runs in this program's place, so that signals and exit codes are
// its own.
inline constexpr const char* generate_purpose =
    "Make a scan of a furnished room, with its ground truth";
inline constexpr const char* evaluate_purpose =
    "Parse generated rooms and judge the results against the truth";
inline constexpr const char* rate_purpose =
    "Compare what people say of objects' safety with what a parse says";
Command add_lab(CLI::App& app, char** argv);

}  // namespace topple::cli
