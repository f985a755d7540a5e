// SPDX-License-Identifier: MIT
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/choice.h"
#include "cli/commands.h"
#include "cli/export_options.h"
#include "cli/further_options.h"
#include "cli/interrupt.h"
#include "cli/keep_to_budget.h"
#include "cli/long_run.h"
#include "cli/option_values.h"
#include "cli/print.h"
#include "cli/shared_options.h"
#include "cli/summary.h"
#include "io/output_folder.h"
#include "io/text.h"
#include "safety/earthquake/intensity.h"
#include "scale/tiled_parse.h"
#include "scale/work_files.h"
#include "topple/device.h"
#include "topple/export.h"
#include "topple/parse.h"

namespace topple::cli {
namespace {

std::string joined(const std::vector<std::string>& names, const char* between) {
    std::string out;
    for (const std::string& name : names) out.append(out.empty() ? "" : between).append(name);
    return out;
}

struct ParseArguments {
    std::optional<std::string> accelerogram, accelerogram_across, accelerogram_up;
    std::optional<double> accelerogram_unit_m_s2;
    std::optional<Acceleration> pga;
    std::optional<std::string> hazard, corrections, cache, materials;
    bool no_cache = false;
    std::string input, backend = "auto", up, disturbance = joined(known_disturbances(), ","),
                       people = joined(ParseOptions{}.people, ",");
    ParseOptions options;
    std::optional<std::string> out;
    std::optional<double> voxel_m, tile_m;
    std::vector<std::string> motions;
    std::string motion_up;
    MotionFileOptions motion_file;
    unsigned threads = 0;
    bool quiet = false;
    OutputOptions output;
    ExportOptions exported;
    Team team;
};

// A sibling of nothing the user owns: named after the input, in the current folder.
std::filesystem::path default_output(const std::filesystem::path& input) {
    std::filesystem::path name = input.has_filename() ? input : input.parent_path();
    std::error_code error;
    name = std::filesystem::is_directory(input, error) ? name.filename() : name.stem();
    if (name.empty() || name == "." || name == "..") name = "scan";
    return name.string() + "-parsed";
}

// Everything that can be wrong with the options is told before a long parse.
void read_options(ParseArguments& a) {
    if (a.voxel_m) {
        // In the library 0 means "from the data"; who writes it here hardly means that.
        if (*a.voxel_m == 0)
            throw wrong_value("--voxel", "0",
                              "a number above 0; leave it out to have the voxels' size found from "
                              "the scan");
        a.options.voxel_m = *a.voxel_m;
    }
    if (a.tile_m) {
        if (*a.tile_m == 0)
            throw wrong_value("--tile", "0", "metres above 0; leave it out for the default");
        a.options.tile_m = *a.tile_m;
    }
    if (!a.up.empty()) a.options.up = parse_up("--up", a.up);
    if (a.pga) a.options.pga_m_s2 = a.pga->m_s2;
    a.options.disturbances = split_commas(a.disturbance);
    a.options.people = split_commas(a.people);
    if (!a.motion_up.empty()) a.motion_file.up = parse_up("--motion-up", a.motion_up);
    if (a.accelerogram_unit_m_s2 && !a.accelerogram)
        throw Error(ErrorKind::usage,
                    "--accelerogram-unit: there is no --accelerogram whose unit it could be");
    check_options(a.options);
    for (const std::string& file : a.motions)
        a.options.motions.push_back(
            std::make_shared<const BodyMotion>(read_motion(file, a.motion_file)));
    if (wants_export(a.exported)) {
        if (a.tile_m)
            throw Error(
                ErrorKind::usage,
                "--tile: what is parsed in blocks can't be exported; leave one of both out");
        check_export(a.exported);
    }
    if (a.accelerogram)
        a.options.accelerogram = read_accelerogram(*a.accelerogram, a.accelerogram_across,
                                                   a.accelerogram_up, a.accelerogram_unit_m_s2);
    if (a.corrections) a.options.corrections = read_corrections(*a.corrections);
    if (a.hazard) a.options.hazard = read_hazard_curve(*a.hazard);
    if (a.materials)
        a.options.materials = std::make_shared<const Materials>(read_materials(*a.materials));
}

// What all processes of a team do before their part of the parse.
void get_ready(ParseArguments& a) {
    a.output.threads = a.threads > 0 ? a.threads : a.team.threads;
    a.options.device = device::open_device(a.backend, a.output.threads);
    a.output.cancelled = [] { return interrupted() != 0; };
    a.exported.threads = a.output.threads;
    a.exported.cancelled = a.output.cancelled;
    a.options.crew = a.team.crew;
    a.options.cancelled = [&team = a.team] {
        return interrupted() != 0 || (team.stopped && team.stopped());
    };
}

int help(ParseArguments& a) {
    read_options(a);
    catch_interrupts();
    get_ready(a);
    help_parse(*a.team.crew, a.options);
    return 0;
}

// What stays of a parse that a signal ended.
std::string left_behind(const ParseArguments& a) {
    const std::optional<WorkLeft> left = work_left(a.input, a.options);
    if (!left) return "";
    return " but " + io::path_text(a.options.work_folder) + ", which holds " + to_text(*left) +
           ": the same command goes on from there; if it shall not, delete that folder";
}

// The cache of an earlier output there is used, and replaced with it.
void keep_cache(const io::OutputFolder& room, ParseArguments& a) {
    a.output.cache_file = a.options.cache_file = room.folder() / "parse.cache";
    std::error_code error;
    const std::filesystem::path earlier = room.destination() / "parse.cache";
    if (!tiles::has_mark(earlier)) return;
    std::filesystem::create_hard_link(earlier, a.options.cache_file, error);
    if (error) std::filesystem::copy_file(earlier, a.options.cache_file, error);
}

// Who writes a peak's unit means it, and isn't asked.
void keep_peak_as_written(const ParseArguments& a, Scene& scene) {
    if (a.pga && a.pga->with_unit) std::erase(scene.notes, safety::unlikely_peak_note(a.pga->m_s2));
}

// What was worst in the parse that these corrections follow: in the output that this one replaces,
// or that whose cache it goes on from.
std::optional<Worst> worst_before(const ParseArguments& a, const std::filesystem::path& out) {
    if (!a.corrections || a.quiet) return std::nullopt;
    std::filesystem::path folder = out;
    if (a.cache) folder = std::filesystem::path(*a.cache).parent_path();
    return worst_of(folder);
}

int run(ParseArguments& a) {
    read_options(a);
    const std::filesystem::path out =
        a.out ? std::filesystem::path(*a.out) : default_output(a.input);
    // So that the report's command says where its own output is.
    if (!a.out) a.output.command.insert(a.output.command.end(), {"-o", out.string()});
    std::error_code error;
    if (!std::filesystem::exists(a.input, error)) {
        throw Error(ErrorKind::input,
                    a.input + ": " + (error ? error.message() : "No such file or folder"));
    }
    catch_interrupts();
    io::check_not_replaced(a.input, out);
    // Throws now, not after the parse, where nothing can be written there.
    std::optional<io::OutputFolder> room(out);
    if (a.cache) a.options.cache_file = *a.cache;
    // It lies there until it goes with the output.
    const bool kept = !a.cache && !a.no_cache && !a.tile_m;
    if (kept)
        keep_cache(*room, a);
    else
        room.reset();
    // Beside the output, where there is room for it, and where the next run finds it.
    a.options.work_folder = out.parent_path() / ("." + out.filename().string() + ".topple-work");
    get_ready(a);
    // Drivers of GPUs reserve what they never use.
    if (device::describe(*a.options.device).backend == device::Backend::native)
        keep_to_budget(a.input, a.options);
    const auto work = [&](Progress& progress) {
        a.options.progress = std::ref(progress);
        a.options.notice = [&](const std::string& line) {
            progress.finish();
            if (!a.quiet) print_to(stderr, "%s\n", line.c_str());
        };
        ParseResult result = parse(a.input, a.options);
        keep_peak_as_written(a, result.scene);
        const std::optional<Worst> before = worst_before(a, out);
        progress("output", 0);
        const auto start = std::chrono::steady_clock::now();
        write_outputs(result, out, a.output);
        const std::chrono::duration<double> output = std::chrono::steady_clock::now() - start;
        std::optional<ExportSummary> exported;
        if (wants_export(a.exported)) {
            progress("export", 0);
            exported = export_scene(result, a.exported);
        }
        progress.finish();
        if (a.quiet) return;
        print_summary(result.scene, out, output.count(), before);
        if (exported) print_export(*exported);
    };
    return run_long(a.quiet, work, [&] { return left_behind(a); });
}

}  // namespace

Command add_parse(CLI::App& app, std::vector<std::string> typed, const Team& team) {
    auto a = std::make_shared<ParseArguments>();
    a->team = team;
    a->output.command = std::move(typed);
    app.add_option(
           "INPUT", a->input,
           "A point cloud (.ply, .pcd, .xyz), a mesh (.obj, .stl, .glb, .gltf, .ply with faces),\n"
           "an OctoMap (.bt, .ot), a LAS file (.las), a volume (.vdb), a sequence folder\n"
           "(depth/*.png, intrinsics.json, and trajectory.txt, trajectory.log or poses.txt), or\n"
           "the same folder without a trajectory: a single frame")
        ->required();
    app.add_option(
        "-o,--output", a->out,
        "Folder for the results (default: INPUT's name with -parsed, in the current folder)");
    app.add_option("--backend", a->backend,
                   "auto (a real GPU if there is one, else native), native, opencl, vulkan")
        ->capture_default_str();
    app.add_option("--voxel", a->voxel_m,
                   "Edge of a solid voxel in metres (default: 2 cm in rooms, finer where dense)");
    add_unit_option(app, a->options.unit_m);
    app.add_option("--up", a->up,
                   "Up in the input's frame, X,Y,Z, as from an IMU (default: found from the scan)");
    app.add_option("--disturbance", a->disturbance,
                   "What may disturb the scene: " + joined(known_disturbances(), ", ") +
                       ", separated by commas")
        ->capture_default_str();
    app.add_option("--people", a->people,
                   "Who is in the room: " + joined(known_people(), ", ") +
                       ",\nseparated by commas; children, toddlers and elderly reach for things")
        ->capture_default_str();
    app.add_option("--wind", a->options.wind_m_s, "Wind speed in m/s")->capture_default_str();
    app.add_option_function<std::string>(
        "--pga", [a](const std::string& text) { a->pga = parse_acceleration("--pga", text); },
        "Peak ground acceleration of the earthquake in m/s^2, or in g as in 0.3g; an\n"
        "accelerogram is scaled to it (default: the accelerogram's own, or 3)");
    app.add_option(
        "--corrections", a->corrections,
        "What is known of the room beside the scan: JSON that says what is one thing,\n"
        "apart, fixed, not there, hollow, how heavy, how slippery, and what it is called,\n"
        "by points in the scan (docs/corrections.md)");
    app.add_option("--title", a->output.title,
                   "Title of the report, as the room's name (default: INPUT's name)");
    app.add_flag("--png", a->output.pictures,
                 "Write the report's main views as pictures, too: view-*.png");
    app.add_flag(
        "--glb", a->output.glb,
        "Write the solids as meshes, too, one per object, coloured as scanned: objects.glb");
    app.add_option("--threads", a->threads, "Threads of the native backend (default: all cores)");
    add_max_memory_option(app, a->options.max_memory_bytes,
                          "Memory to keep to: in blocks fewer are held at a time, and a scan that\n"
                          "would need more is refused (default: 3/4 of what is free; of inputs of\n"
                          "megabytes 2 GB a MB)");
    app.add_flag("--quiet", a->quiet, "Print errors only");
    further_options(app);
    add_isolate_option(app, a->options.isolate);
    app.add_option("--walks", a->options.walks, "Walks of people that are sampled")
        ->check(whole_number)
        ->capture_default_str();
    CLI::Option* const motion = app.add_option(
        "--motion", a->motions,
        "How walkers' bodies move: a recording, .bvh or a table of joint positions; given again\n"
        "for more, each as often as the others (default: published figures of gait)");
    motion->allow_extra_args(false);
    app.add_option("--motion-unit", a->motion_file.unit_m,
                   "Metres in the recording's unit (default: from the size of the body)")
        ->check(number_above_0)
        ->needs(motion);
    app.add_option("--motion-rate", a->motion_file.rate_hz,
                   "Frames a second of a recording that has no times")
        ->check(number_above_0)
        ->needs(motion);
    app.add_option("--motion-up", a->motion_up,
                   "Up in the recording, X,Y,Z (default: from head and feet)")
        ->needs(motion);
    app.add_option("--wind-from", a->options.wind_from_deg,
                   "Where the wind comes from, degrees clockwise from the scene's north\n"
                   "(default: from all sides)");
    CLI::Option* const record = app.add_option(
        "--accelerogram", a->accelerogram,
        "Recorded earthquake instead of made-up ones: JSON (dT, accel_data), PEER's .AT2, or\n"
        "lines of time in s and acceleration");
    app.add_option("--accelerogram-across", a->accelerogram_across,
                   "Its level component a quarter turn to the left, in a file of its own")
        ->needs(record);
    app.add_option("--accelerogram-up", a->accelerogram_up, "Its vertical component, upwards")
        ->needs(record);
    app.add_option_function<std::string>(
           "--accelerogram-unit",
           [a](const std::string& unit) {
               a->accelerogram_unit_m_s2 = acceleration_unit_m_s2(unit);
           },
           "Its unit: g, m/s2 or cm/s2 (default: what the file says, else g)")
        ->check(one_of({"g", "m/s2", "cm/s2"}));
    app.add_option("--floor-amplification", a->options.floor_amplification,
                   "How many times as strongly as the ground shakes what things stand on, as on\n"
                   "upper floors, and shelves and desks do (about 2.5)")
        ->capture_default_str();
    app.add_option("--hazard", a->hazard,
                   "How often the ground shakes there: JSON (pga_g, per_year), or lines of peak\n"
                   "acceleration in g and annual rate; gives how often each object falls");
    CLI::Option* const cache = app.add_option(
        "--cache", a->cache,
        "File for what does not depend on corrections and disturbances, so that the next parse\n"
        "of the scan is quick (default: parse.cache in the folder for the results)");
    app.add_flag("--no-cache", a->no_cache, "Keep nothing for the next parse")->excludes(cache);
    app.add_option("--tolerable", a->options.tolerable_J,
                   "Risk in joules per event up to which an object may stay as it is; for others\n"
                   "the report says where to move them, or what a fixing must hold")
        ->capture_default_str();
    app.add_option("--density", a->options.density_kg_m3, "Density of all objects in kg/m^3")
        ->capture_default_str();
    app.add_option("--materials", a->materials,
                   "household, or a file: what things weigh by their names (--corrections) or\n"
                   "else by their sizes, instead of all by --density; masses' errors then say how\n"
                   "little that is known");
    app.add_option_function<std::string>(
           "--contents",
           [a](const std::string& text) {
               a->options.contents_kg_m3 = parse_contents("--contents", text);
           },
           "What closed furniture holds, in kg/m^3 of its inside, beside boards of 18 mm; or\n"
           "solid, to weigh all things as if they were solid")
        ->default_str("68");
    app.add_option("--friction", a->options.friction, "Coefficient of friction")
        ->capture_default_str();
    app.add_option("--seed", a->options.seed, "Seed of everything random")
        ->check(whole_number)
        ->capture_default_str();
    app.add_option("--stability-level", a->options.stability_level,
                   "How far an object must stay put to be one by itself: the disturbance W of\n"
                   "the paper's Eq. 8, as a share of m g h; with more, more is one with the floor")
        ->capture_default_str();
    app.add_option("--grouping-time", a->options.grouping_time_s,
                   "Seconds for the search for objects, about; where that is too few, the\n"
                   "objects depend on the machine (default: as long as it takes)");
    app.add_option(
        "--tile", a->tile_m,
        "Parse any cloud in blocks of 5 m, as those of over 4 million points are, so\n"
        "that it may be larger than memory; the blocks of a tile of this edge in metres\n"
        "are read and handed out together (default: one by one; the result is the same)");
    app.add_flag("--fields", a->options.space_fields,
                 "Write how people and wind pass through space, too: fields.vdb, field-*.png");
    app.add_flag("--octomap", a->output.octomap,
                 "Write what was seen to be free and occupied as an OctoMap, too: map.bt");
    add_export_options(app, a->exported);
    return [a] { return a->team.leads ? run(*a) : help(*a); };
}

}  // namespace topple::cli
