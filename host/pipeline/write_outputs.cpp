// SPDX-License-Identifier: MIT
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "core/solid_scene.h"
#include "core/thread_pool.h"
#include "export/object_surfaces.h"
#include "export/objects_glb.h"
#include "io/output_folder.h"
#include "io/text.h"
#include "points/formats/octomap.h"
#include "report/field_slices.h"
#include "report/pictures.h"
#include "report/report.h"
#include "result/landscapes_json.h"
#include "result/scene_json.h"
#include "result/solids_file.h"
#include "result/things_json.h"
#include "result/write_ply.h"
#include "safety/disturbances.h"
#include "scale/tiled_result.h"
#include "topple/parse.h"
#include "topple/session.h"
#include "vdb/voxel_scene.h"
#include "vdb/write_space_fields.h"

namespace topple {
namespace {

using Poll = std::function<void()>;

void write_map(const std::filesystem::path& file, const vdb::VoxelScene& voxels) {
    const vdb::Tiles tiles = voxels.tiles(true);
    const std::vector<std::uint8_t> states = voxels.states(tiles);
    io::write_octomap(file, voxels.frame().voxel_m, {tiles.x, tiles.y, tiles.z, states});
}

void write_points(const std::filesystem::path& file, const ParseResult& result, const Poll& poll) {
    if (result.tiled) {
        result.tiled->write_points(file, poll);
    } else {
        io::write_points_ply(file, result.scene.points);
    }
}

// A cache that was not written is none: the next parse begins anew.
void move_in(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::error_code error;
    if (!std::filesystem::exists(from, error)) return;
    std::filesystem::rename(from, to, error);
    if (error) std::filesystem::copy_file(from, to, error);
    if (error) io::fail(to, "can't be written: " + error.message());
}

// Of a cloud that was parsed in blocks nothing is known within voxels.
std::vector<ObjectSurface> surfaces_of(const ParseResult& result, const vdb::VoxelScene& voxels,
                                       unsigned threads) {
    if (!result.solids)
        return object_surfaces(result.scene, voxels.solid_cells(), {}, voxels.frame(), threads);
    return object_surfaces(result.scene, result.solids->with_strays(), result.solids->boundary(),
                           voxels.frame(), threads);
}

// What parses so again, as far as the result tells: what was reckoned with is asked for again.
std::vector<std::string> command_for(const Scene& scene, const std::filesystem::path& folder) {
    std::vector<std::string> words{"topple", "parse", scene.source};
    std::string disturbances, people;
    for (const auto& [name, field] : scene.fields)
        disturbances.append(disturbances.empty() ? "" : ",").append(name);
    for (const std::string& name : scene.people)
        people.append(people.empty() ? "" : ",").append(name);
    ParseOptions all;
    if (!scene.people.empty()) all.people = scene.people;
    if (!scene.fields.empty() && scene.fields.size() < safety::acting_kinds(all).size())
        words.insert(words.end(), {"--disturbance", disturbances});
    if (!people.empty()) words.insert(words.end(), {"--people", people});
    words.insert(words.end(), {"-o", folder.string()});
    return words;
}

// The files of an output, each written by itself: what takes longest first. folder: where they are
// made; words: of the report.
std::vector<std::function<void()>> writers(const std::filesystem::path& folder,
                                           const ParseResult& result, const OutputOptions& options,
                                           const report::ReportWords& words, const Poll& poll) {
    const Scene& scene = result.scene;
    // Of a building they are read from disk, by the first that wants them.
    const auto load = [&result] {
        return result.tiled ? std::make_shared<const vdb::VoxelScene>(result.tiled->load_voxels())
                            : result.voxels;
    };
    const std::shared_future<std::shared_ptr<const vdb::VoxelScene>> voxels =
        std::async(std::launch::deferred, load);
    // Those of a building are too large for a page.
    const bool with_surfaces = !result.tiled || options.glb;
    // What the page shows beside them another thread makes meanwhile.
    const std::shared_future<std::shared_ptr<report::Report>> page =
        std::async(std::launch::deferred, [=, &scene] {
            return std::make_shared<report::Report>(scene, with_surfaces && !scene.solid.x.empty(),
                                                    words);
        });
    std::vector<std::function<void()>> out;
    out.emplace_back([=, &result, &options, &scene, &poll] {
        std::vector<ObjectSurface> surfaces;
        if (with_surfaces) surfaces = surfaces_of(result, *voxels.get(), options.threads);
        poll();
        page.get()->write(folder / "report.html", surfaces, options.threads);
        poll();
        if (options.glb)
            write_objects_glb(folder / "objects.glb", scene, surfaces, voxels.get()->frame());
    });
    out.emplace_back([=] { page.wait(); });
    out.emplace_back([=] { voxels.get()->write(folder / "volume.vdb"); });
    out.emplace_back([=, &result, &poll] { write_points(folder / "points.ply", result, poll); });
    if (options.pictures) out.emplace_back([=, &scene] { report::write_pictures(folder, scene); });
    if (!result.space_fields.empty())
        out.emplace_back([=, &result] {
            vdb::write_space_fields(folder / "fields.vdb", result.space_fields);
            report::write_field_slices(folder, result.space_fields, result.scene);
        });
    out.emplace_back([=, &scene] { io::write_solid_ply(folder / "solid.ply", scene.solid); });
    if (result.solids)
        out.emplace_back([=, &result] { io::write_solids(folder / "solids.bin", *result.solids); });
    if (!options.cache_file.empty())
        out.emplace_back([=, &options] { move_in(options.cache_file, folder / "parse.cache"); });
    if (options.octomap) out.emplace_back([=] { write_map(folder / "map.bt", *voxels.get()); });
    out.emplace_back([=, &scene] {
        io::write_landscapes_json(folder / "landscapes.json", scene);
        io::write_scene_json(folder / "scene.json", scene);
    });
    return out;
}

// things: what a session knows of the result besides; null: it is of no session.
void write_folder(const ParseResult& result, const LiveScene* things,
                  const std::filesystem::path& folder, const OutputOptions& options) {
    if (!result.tiled && !result.voxels)
        throw Error(ErrorKind::usage,
                    "write_outputs: the result was read from a folder, which has no voxel grids, "
                    "or no parse returned it: parse the scan again, or copy that folder");
    if (result.scene.points.x.size() != result.scene.points.primitive.size()) {
        throw Error(ErrorKind::usage,
                    "the result has no coordinates of its points: call add_coordinates() first");
    }
    io::check_not_replaced(result.scene.source, folder);
    io::OutputFolder out(folder);
    const Poll poll = [&] {
        if (options.cancelled && options.cancelled())
            throw Error(ErrorKind::cancelled, "cancelled");
    };
    auto files =
        writers(out.folder(), result, options,
                {options.command.empty() ? command_for(result.scene, folder) : options.command,
                 options.title},
                poll);
    if (things)
        files.emplace_back([&] { io::write_things_json(out.folder() / "things.json", *things); });
    // Surfaces have threads of their own.
    ThreadPool(options.threads == 1 ? 1 : 2).each(files.size(), 1, [&](std::size_t n) {
        poll();
        files[n]();
    });
    poll();
    out.commit();
    if (result.tiled) result.tiled->finished();
}

}  // namespace

void write_outputs(const ParseResult& result, const std::filesystem::path& folder,
                   const OutputOptions& options) {
    write_folder(result, nullptr, folder, options);
}

void write_outputs(const LiveScene& found, const std::filesystem::path& folder,
                   const OutputOptions& options) {
    if (!found.result)
        throw Error(ErrorKind::usage, "write_outputs: there is no result; call update() first");
    write_folder(*found.result, &found, folder, options);
}

}  // namespace topple
