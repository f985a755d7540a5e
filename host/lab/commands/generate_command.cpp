// SPDX-License-Identifier: MIT
#include <filesystem>
#include <memory>
#include <string>

#include "cli/choice.h"
#include "cli/interrupt.h"
#include "cli/print.h"
#include "io/output_folder.h"
#include "io/text.h"
#include "lab/commands/commands.h"
#include "lab/rooms/building.h"
#include "lab/rooms/furnished_room.h"
#include "lab/rooms/kinds.h"
#include "lab/scan/depth_camera.h"
#include "lab/scan/files.h"
#include "lab/scan/scan.h"
#include "lab/solids/ground_truth.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

struct GenerateArguments {
    std::string out;
    scenes::RoomOptions room;
    scenes::CameraOptions camera;
    bool is_building = false;
    scenes::BuildingOptions building;
    std::string kind;  // empty: the plain or varied room as it always was
    scenes::ScanOptions scan;
};

int run_building(const GenerateArguments& a) {
    if (std::filesystem::path(a.out).extension() != ".ply") {
        throw Error(ErrorKind::usage, a.out + ": a building is one cloud; choose a name with .ply");
    }
    catch_interrupts();
    const auto summary = scenes::write_building(
        a.out, a.building, [](std::size_t, std::size_t) { return interrupted() == 0; });
    if (interrupted() != 0) return interrupted_exit();
    print("%s: %s, %.1f mm apart, in %s on %s, %s\n", a.out.c_str(),
          io::counted(a.building.points, "point").c_str(), 1000 * summary.spacing_m,
          io::counted(summary.rooms, "room").c_str(),
          io::counted(summary.storeys, "storey").c_str(),
          io::counted(summary.objects, "object").c_str());
    return 0;
}

int run_kind(const GenerateArguments& a) {
    io::OutputFolder out(a.out, scenes::generated_scan);
    const scenes::World world = scenes::make_world(a.kind, a.scan.seed);
    const scenes::Scan scan = scenes::scan(world, a.scan);
    scenes::write_scan(out.folder(), world, scan, a.scan, a.kind);
    out.commit();
    print("%s: %s of a %s room, %s, %s, %s\n", a.out.c_str(), to_string(a.scan.kind),
          a.kind.c_str(), io::counted(world.objects.size() - 1, "object").c_str(),
          scan.frames.empty() ? io::counted(scan.cloud.size(), "point").c_str()
                              : io::counted(scan.frames.size(), "frame").c_str(),
          io::counted(scan.truth.size(), "true point").c_str());
    return 0;
}

int run(const GenerateArguments& a) {
    if (a.camera.frames < 1 || a.camera.frames > 10000) {
        throw Error(ErrorKind::usage,
                    "--frames " + std::to_string(a.camera.frames) + ": expected 1 to 10000");
    }
    io::OutputFolder out(a.out, scenes::generated_scan);
    const scenes::World world = scenes::furnished_room(a.room);
    const scenes::Sequence sequence = scenes::walk(world, a.camera);
    scenes::write_sequence(out.folder(), world, sequence);
    out.commit();
    print("%s: %zu frames, %zu fused points, %zu parts, %zu objects\n", a.out.c_str(),
          sequence.frames.size(), sequence.cloud.size(), world.parts.size(), world.objects.size());
    return 0;
}

}  // namespace

Command add_generate(CLI::App& app) {
    auto a = std::make_shared<GenerateArguments>();
    app.add_option(
           "OUT", a->out,
           "Folder for the depth frames, poses, fused cloud and truth.json; with --building\n"
           "a .ply, beside which the truth is put as .truth.json")
        ->required();
    app.add_option("--seed", a->room.seed, "Seed of the room and of the sensor's noise")
        ->check(whole_number)
        ->capture_default_str();
    auto* frames =
        app.add_option("--frames", a->camera.frames, "Depth frames of the walk through the room")
            ->capture_default_str();
    auto* tilt = app.add_option("--tilt", a->room.tilt_deg,
                                "Tilt of the input's frame against the room, degrees")
                     ->capture_default_str();
    add_furniture(app, a->room.varied);
    auto* single =
        app.add_flag("--single", a->camera.single, "One frame only, without a trajectory");
    auto* building = app.add_flag("--building", a->is_building,
                                  "A building of such rooms from a laser scanner, as one cloud");
    for (auto* option : {frames, tilt, single}) building->excludes(option);
    auto* kind =
        app.add_option("--kind", a->kind,
                       "A room of this family instead, scanned as --scan says, with truth.ply")
            ->check(one_of(scenes::kinds()))
            ->excludes(building)
            ->excludes(tilt)
            ->excludes(single);
    add_scan(app, a->scan.kind)->needs(kind);
    app.add_option("--points", a->building.points, "Points of the building")
        ->needs(building)
        ->check(whole_number)
        ->capture_default_str();
    auto* spacing = app.add_option(
        "--spacing", a->building.spacing_m,
        "Metres between neighbouring points: of a building, where it gives with --points the\n"
        "number of rooms, or of a sparse or dense cloud");
    app.add_option("--storeys", a->building.storeys,
                   "Storeys of the building (default: one for every 40 rooms)")
        ->needs(building)
        ->check(whole_number);
    return [a, frames, spacing, kind] {
        if (*spacing && !a->is_building && !*kind)
            throw Error(ErrorKind::usage, "--spacing needs --building or --kind");
        if (*kind) {
            a->scan.seed = a->room.seed;
            if (*frames) a->scan.frames = a->camera.frames;
            if (*spacing) a->scan.spacing_m = a->building.spacing_m;
            return run_kind(*a);
        }
        if (a->is_building) {
            a->building.seed = a->room.seed;
            a->building.varied = a->room.varied;
            return run_building(*a);
        }
        a->camera.seed = a->room.seed;
        return run(*a);
    };
}

}  // namespace topple::cli
