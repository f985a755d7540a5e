// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/export_options.h"
#include "cli/print.h"
#include "export/formats.h"

namespace topple::cli {

void add_export_options(CLI::App& app, ExportOptions& options) {
    for (const exports::Format& format : exports::formats()) {
        app.add_option_function<std::string>(
            std::string("--") + format.name,
            [&options, path = format.path](const std::string& value) { options.*path = value; },
            format.help);
    }
    app.add_flag(
        "--no-visuals", [&options](std::int64_t) { options.visuals = false; },
        "Only what collides, not what is seen");
    app.add_flag(
        "--no-joints", [&options](std::int64_t) { options.joints = false; },
        "Doors and drawers stay parts of their furniture");
}

bool wants_export(const ExportOptions& options) {
    return std::ranges::any_of(exports::formats(), [&](const exports::Format& format) {
        return !(options.*format.path).empty();
    });
}

void print_export(const ExportSummary& summary) {
    std::uint64_t free = 0, parts = 0;
    double furthest_m = 0;
    for (const ExportedBody& body : summary.bodies) {
        parts += body.parts;
        free += !body.fixed && body.parts > 0;
        furthest_m = std::max(furthest_m, std::abs(body.moved_m[2]));
    }
    print(
        "%llu free bodies, %llu convex parts in all, deepest overlap %.3f mm; let down by at most "
        "%.1f mm\n",
        static_cast<unsigned long long>(free), static_cast<unsigned long long>(parts),
        1e3 * summary.deepest_overlap_m, 1e3 * furthest_m);
    if (!summary.fronts.empty())
        print("%zu doors and drawers on joints; --no-joints leaves them out\n",
              summary.fronts.size());
    for (const std::string& note : summary.notes) print("%s\n", note.c_str());
    if (!std::isfinite(summary.floor_m)) return;
    print("The floor lies at z = %.3f m", summary.floor_m);
    if (summary.free_radius_m > 0)
        print("; within %.2f m of x = %.2f, y = %.2f nothing stands on it", summary.free_radius_m,
              summary.free_place_m[0], summary.free_place_m[1]);
    print("\n");
}

Command add_export(CLI::App& app) {
    struct ExportArguments {
        std::string parsed;
        ExportOptions options;
    };
    auto a = std::make_shared<ExportArguments>();
    app.add_option("OUT", a->parsed, "Output folder of a parse")->required();
    add_export_options(app, a->options);
    app.add_option("--threads", a->options.threads, "Threads; else all cores")->check(whole_number);
    return [a] {
        print_export(export_output(a->parsed, a->options));
        return 0;
    };
}

}  // namespace topple::cli
