// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "core/thread_pool.h"
#include "export/separate.h"
#include "export/sim_scene.h"
#include "export/write_mjcf.h"
#include "io/scene_json.h"
#include "io/solids_file.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

struct ExportArguments {
    std::string parsed, mjcf;
    unsigned threads = 0;
};

exports::SimScene load(const std::filesystem::path& folder, unsigned count) {
    const Scene scene = io::read_scene_json(folder / "scene.json");
    const std::filesystem::path solids = folder / "solids.bin";
    if (!std::filesystem::exists(solids)) {
        throw Error(ErrorKind::input,
                    solids.string() +
                        ": is missing; parse the scan again (a cloud that was parsed in blocks "
                        "has none and can't be exported)");
    }
    ThreadPool threads(count);
    return exports::sim_scene(scene, *io::read_solids(solids), threads);
}

void print_summary(const exports::SimScene& sim) {
    std::size_t free = 0, pads = 0, held = 0, struts = 0, parts = 0;
    double furthest_m = 0;
    for (const exports::Body& body : sim.bodies) {
        parts += body.parts.size();
        free += !body.fixed;
        pads += body.on_pad;
        held += body.held;
        struts += static_cast<std::size_t>(body.struts);
        furthest_m = std::max(furthest_m, std::abs(body.moved_m[2]));
    }
    std::printf(
        "%zu free bodies, %zu convex parts in all, deepest overlap %.3f mm; let down by at most "
        "%.1f mm\n",
        free, parts, 1e3 * exports::deepest_overlap_m(sim.bodies), 1e3 * furthest_m);
    if (pads + held + struts > 0)
        std::printf(
            "What carries them was not seen: %zu stand on pads, %zu are held where they are; %zu "
            "struts\n",
            pads, held, struts);
}

int run(const ExportArguments& a) {
    if (a.mjcf.empty())
        throw Error(ErrorKind::usage, "export: say what to make (--mjcf DIR); see topple --help");
    const exports::SimScene sim = load(a.parsed, a.threads);
    exports::write_mjcf(a.mjcf, sim);
    print_summary(sim);
    return 0;
}

}  // namespace

Command add_export(CLI::App& app) {
    auto a = std::make_shared<ExportArguments>();
    app.add_option("OUT", a->parsed, "Output folder of a parse")->required();
    app.add_option("--mjcf", a->mjcf, "Folder to write scene.xml into, MuJoCo's format");
    app.add_option("--threads", a->threads, "Threads; else all cores")->check(whole_number);
    return [a] { return run(*a); };
}

}  // namespace topple::cli
