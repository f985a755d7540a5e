// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cli/choice.h"
#include "io/text.h"
#include "scenes/scan/scan.h"
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

// Adds --furniture, which sets whether generated rooms are the varied ones.
inline void add_furniture(CLI::App& app, bool& varied) {
    app.add_option_function<std::string>(
           "--furniture", [&varied](const std::string& kind) { varied = kind == "varied"; },
           "plain (boxes, cylinders, cones), or varied (turned, hollow, rounded, splayed, leaning\n"
           "and piled things, levels, a ceiling)")
        ->check(one_of({"plain", "varied"}))
        ->default_str("plain");
}

// Adds --scan, which sets how a generated room is scanned.
inline CLI::Option* add_scan(CLI::App& app, scenes::ScanKind& kind) {
    std::map<std::string, scenes::ScanKind> kinds;
    std::vector<std::string> names;
    using enum scenes::ScanKind;
    for (const auto each : {walk, sparse, cloud, laser, single}) {
        names.emplace_back(scenes::to_string(each));
        kinds[names.back()] = each;
    }
    return app
        .add_option_function<std::string>(
            "--scan", [&kind, kinds](const std::string& name) { kind = kinds.at(name); },
            "walk: depth and colour frames of a hand-held camera; sparse or cloud: points\n"
            "fused of such; laser: points from stations; single: one frame without its pose")
        ->check(one_of(names))
        ->default_str(scenes::to_string(kind));
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
Command add_generate(CLI::App& app);
Command add_evaluate(CLI::App& app);
Command add_estimate(CLI::App& app);
Command add_landscape(CLI::App& app);
Command add_export(CLI::App& app);
Command add_verify(CLI::App& app);
Command add_view(CLI::App& app);
Command add_perf(CLI::App& app);

}  // namespace topple::cli
