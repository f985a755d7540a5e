// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "export/export_folder.h"
#include "export/separate.h"
#include "export/write_mjcf.h"
#include "export/write_sdf.h"
#include "export/write_urdf.h"
#include "export/write_usd.h"
#include "pipeline/read_sim_scene.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

struct ExportArguments {
    std::string parsed, mjcf, urdf, sdf, usd;
    bool no_visuals = false;
    unsigned threads = 0;
};

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
    if (a.mjcf.empty() && a.urdf.empty() && a.sdf.empty() && a.usd.empty())
        throw Error(ErrorKind::usage,
                    "export: say what to make (--mjcf, --urdf, --sdf or --usd); see topple --help");
    if (!a.usd.empty() && std::filesystem::path(a.usd).extension() != ".usda")
        throw Error(ErrorKind::usage, "export: --usd " + a.usd + ": the name must end in .usda");
    for (const auto& [folder, name] :
         {std::pair{a.mjcf, "scene.xml"}, {a.urdf, "scene.urdf"}, {a.sdf, "scene.sdf"}})
        if (!folder.empty()) exports::check_ours(std::filesystem::path(folder) / name);
    if (!a.usd.empty()) exports::check_ours(a.usd);
    const exports::SimScene sim =
        read_sim_scene(a.parsed, {.visuals = !a.no_visuals, .threads = a.threads});
    if (!a.mjcf.empty()) exports::write_mjcf(a.mjcf, sim);
    if (!a.urdf.empty()) exports::write_urdf(a.urdf, sim);
    if (!a.sdf.empty()) exports::write_sdf(a.sdf, sim);
    if (!a.usd.empty()) exports::write_usd(a.usd, sim);
    print_summary(sim);
    return 0;
}

}  // namespace

Command add_export(CLI::App& app) {
    auto a = std::make_shared<ExportArguments>();
    app.add_option("OUT", a->parsed, "Output folder of a parse")->required();
    app.add_option("--mjcf", a->mjcf, "Folder to write scene.xml into, MuJoCo's format");
    app.add_option("--urdf", a->urdf, "Folder to write scene.urdf into, for Bullet and ROS");
    app.add_option("--sdf", a->sdf, "Folder to write scene.sdf into, for Gazebo");
    app.add_option("--usd", a->usd, "File to write, .usda, for Omniverse and others that read USD");
    app.add_flag("--no-visuals", a->no_visuals, "Only what collides, not what is seen");
    app.add_option("--threads", a->threads, "Threads; else all cores")->check(whole_number);
    return [a] { return run(*a); };
}

}  // namespace topple::cli
