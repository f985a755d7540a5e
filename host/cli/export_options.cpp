// SPDX-License-Identifier: MIT
#include "cli/export_options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

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
}

bool wants_export(const ExportOptions& options) {
    return std::ranges::any_of(exports::formats(), [&](const exports::Format& format) {
        return !(options.*format.path).empty();
    });
}

namespace {

// What a body became, where that is not what was parsed.
void print_misfits(const ExportSummary& summary) {
    constexpr double much = 0.5, most_named = 5;
    std::string names;
    std::size_t count = 0;
    for (const ExportedBody& body : summary.bodies) {
        const bool fits = body.fixed || body.lost_m3 <= much * body.solid_m3;
        if (fits || ++count > most_named) continue;
        if (!names.empty()) names += ", ";
        names += body.name;
    }
    if (count > most_named) names += ", ...";
    if (count > 0)
        std::printf("%llu lay in others so deep that more than half of each was cut off: %s\n",
                    static_cast<unsigned long long>(count), names.c_str());
}

}  // namespace

void print_export(const ExportSummary& summary) {
    std::uint64_t free = 0, pads = 0, held = 0, struts = 0, parts = 0;
    double furthest_m = 0;
    for (const ExportedBody& body : summary.bodies) {
        parts += body.parts;
        free += !body.fixed;
        pads += body.on_pad;
        held += body.held;
        struts += body.struts;
        furthest_m = std::max(furthest_m, std::abs(body.moved_m[2]));
    }
    std::printf(
        "%llu free bodies, %llu convex parts in all, deepest overlap %.3f mm; let down by at most "
        "%.1f mm\n",
        static_cast<unsigned long long>(free), static_cast<unsigned long long>(parts),
        1e3 * summary.deepest_overlap_m, 1e3 * furthest_m);
    if (pads + held + struts > 0)
        std::printf(
            "Without a footing, which was not seen or lay in others: %llu stand on pads made for "
            "them, %llu are held where they are; %llu struts stand for feet\n",
            static_cast<unsigned long long>(pads), static_cast<unsigned long long>(held),
            static_cast<unsigned long long>(struts));
    print_misfits(summary);
    if (!std::isfinite(summary.floor_m)) return;
    std::printf("The floor lies at z = %.3f m", summary.floor_m);
    if (summary.free_radius_m > 0)
        std::printf("; within %.2f m of x = %.2f, y = %.2f nothing stands on it",
                    summary.free_radius_m, summary.free_place_m[0], summary.free_place_m[1]);
    std::printf("\n");
}

}  // namespace topple::cli
