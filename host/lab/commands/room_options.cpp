// SPDX-License-Identifier: MIT
#include <map>
#include <string>
#include <vector>

#include "lab/commands/commands.h"

namespace topple::cli {

void add_furniture(CLI::App& app, bool& varied) {
    app.add_option_function<std::string>(
           "--furniture", [&varied](const std::string& kind) { varied = kind == "varied"; },
           "plain (boxes, cylinders, cones), or varied (turned, hollow, rounded, splayed, leaning\n"
           "and piled things, levels, a ceiling)")
        ->check(one_of({"plain", "varied"}))
        ->default_str("plain");
}

CLI::Option* add_scan(CLI::App& app, scenes::ScanKind& kind) {
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

}  // namespace topple::cli
