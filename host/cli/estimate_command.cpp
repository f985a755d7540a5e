// SPDX-License-Identifier: MIT
#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/long_run.h"
#include "cli/print.h"
#include "cli/shared_options.h"
#include "core/json.h"
#include "io/text.h"
#include "points/budget.h"
#include "points/formats/read_cloud.h"
#include "scale/estimate.h"
#include "topple/device.h"

namespace topple::cli {
namespace {

struct EstimateArguments {
    std::string input, backend = "auto";
    unsigned threads = 0;
    bool quiet = false, json = false;
    ParseOptions options;
};

// Whether the parse would be refused, as far as an estimate tells.
std::string limit_text(const Estimate& e, bool may_be_tiled, std::uint64_t max_memory_bytes) {
    const std::string least = "a parse asks for about " + io::bytes_text(e.least_bytes);
    const std::string given = io::bytes_text(max_memory_bytes) + " of --max-memory ";
    if (max_memory_bytes >= 2 * e.least_bytes) return given + "suffice; " + least;
    const std::string mend =
        std::string("; use a larger --voxel") + (e.tiled || !may_be_tiled ? "" : ", or --tile 5");
    if (2 * max_memory_bytes >= e.least_bytes) return given + "may be too few: " + least + mend;
    return given + "are too few, and the parse would be refused: " + least + mend;
}

void print_json(const Estimate& e) {
    const OrderedJson json{
        {"points", e.points},
        {"frames", e.frames},
        {"pixels", e.pixels},
        {"surface_m2", e.surface_m2},
        {"tiled", e.tiled},
        {"cell_m", e.cell_m},
        {"spacing_m", e.spacing_m},
        {"voxel_m", e.voxel_m},
        {"views", e.views},
        {"patches_m", e.patches_m},
        {"ground_m2", e.ground_m2},
        {"box_voxels", e.box_voxels},
        {"surface_voxels", e.surface_voxels},
        {"unit_hint", e.unit_hint},
        {"seconds", e.seconds},
        {"processor_s", e.processor_s},
        {"probe_s", e.probe_s},
        {"least_bytes", e.least_bytes},
        {"memory_bytes", e.memory_bytes},
        {"allowed_bytes", e.allowed_bytes},
        {"refusal", e.refusal},
        {"work_bytes", e.work_bytes},
        {"output_bytes", e.output_bytes},
    };
    print("%s\n", json.dump(1).c_str());
}

int run(EstimateArguments& a) {
    catch_interrupts();
    a.options.device = device::open_device(a.backend, a.threads);
    a.options.cancelled = [] { return interrupted() != 0; };
    return run_long(a.quiet, [&](Progress& progress) {
        a.options.progress = std::ref(progress);
        const Estimate e = estimate(a.input, a.options);
        progress.finish();
        if (a.json) return print_json(e);
        if (e.frames > 0)
            print("input    %llu frames, about %.2g million points when fused\n",
                  static_cast<unsigned long long>(e.frames), static_cast<double>(e.points) / 1e6);
        else
            print("input    %llu points\n", static_cast<unsigned long long>(e.points));
        if (!e.unit_hint.empty()) print("unit     %s\n", e.unit_hint.c_str());
        print("surface  about %.3g m2\n", e.surface_m2);
        if (e.tiled)
            print("parsed   in blocks, thinned to one point per %.3g mm\n", 1000 * e.cell_m);
        else
            print("parsed   in one piece, voxels of %s m, points about %s mm apart\n",
                  io::short_number(e.voxel_m).c_str(), io::two_digits(1000 * e.spacing_m).c_str());
        print("time     about %s\n", duration_text(e.seconds).c_str());
        print("memory   about %s\n", io::bytes_text(e.memory_bytes).c_str());
        if (a.options.max_memory_bytes > 0)
            print("limit    %s\n",
                  limit_text(e, io::can_stream(a.input), a.options.max_memory_bytes).c_str());
        else if (!e.refusal.empty())
            print("limit    the parse would be refused: %s\n", e.refusal.c_str());
        if (e.work_bytes > 0)
            print("disk     about %s while it works\n", io::bytes_text(e.work_bytes).c_str());
        print("results  about %s%s\n", io::bytes_text(e.output_bytes).c_str(),
              e.tiled ? "" : ", with parse.cache");
    });
}

}  // namespace

Command add_estimate(CLI::App& app) {
    auto a = std::make_shared<EstimateArguments>();
    app.add_option("INPUT", a->input, "What `topple parse` would be given")->required();
    app.add_option("--backend", a->backend, "As for parse")->capture_default_str();
    app.add_option("--voxel", a->options.voxel_m, "Edge of a solid voxel in metres, as for parse")
        ->check(number_above_0);
    add_unit_option(app, a->options.unit_m);
    add_isolate_option(app, a->options.isolate);
    app.add_option("--tile", a->options.tile_m, "Edge of the tiles in metres, as for parse")
        ->check(number_above_0);
    add_max_memory_option(app, a->options.max_memory_bytes,
                          "Memory to keep to, as for parse; whether it suffices is told");
    app.add_option("--threads", a->threads, "Threads of the native backend (default: all cores)");
    app.add_flag("--json", a->json, "Print it as JSON, in seconds and bytes");
    app.add_flag("--quiet", a->quiet, "Print the estimate and errors only");
    return [a] { return run(*a); };
}

}  // namespace topple::cli
