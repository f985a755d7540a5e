// SPDX-License-Identifier: MIT
#include <future>
#include <memory>

#include "io/landscapes_json.h"
#include "io/octomap.h"
#include "io/output_folder.h"
#include "io/scene_json.h"
#include "io/write_ply.h"
#include "pipeline/objects_glb.h"
#include "pipeline/tiled_result.h"
#include "report/pictures.h"
#include "report/report.h"
#include "topple/parse.h"
#include "vdb/voxel_scene.h"

namespace topple {
namespace {

void write_map(const std::filesystem::path& file, const vdb::VoxelScene& voxels) {
    const vdb::Tiles tiles = voxels.tiles(true);
    const std::vector<std::uint8_t> states = voxels.states(tiles);
    io::write_octomap(file, voxels.frame().voxel_m, {tiles.x, tiles.y, tiles.z, states});
}

void write_points(const std::filesystem::path& file, const ParseResult& result) {
    if (result.tiled) {
        result.tiled->write_points(file);
    } else {
        io::write_points_ply(file, result.scene.points);
    }
}

void write_all_else(const std::filesystem::path& folder, const ParseResult& result,
                    const OutputOptions& options) {
    const Scene& scene = result.scene;
    const auto voxels = result.tiled
                            ? std::make_shared<const vdb::VoxelScene>(result.tiled->load_voxels())
                            : result.voxels;
    voxels->write(folder / "volume.vdb");
    io::write_solid_ply(folder / "solid.ply", scene.solid);
    report::write_report(folder / "report.html", scene);
    if (options.pictures) report::write_pictures(folder, scene);
    if (options.glb) write_objects_glb(folder / "objects.glb", scene, *voxels);
    if (options.octomap) write_map(folder / "map.bt", *voxels);
    io::write_landscapes_json(folder / "landscapes.json", scene);
    io::write_scene_json(folder / "scene.json", scene);
}

}  // namespace

void write_outputs(const ParseResult& result, const std::filesystem::path& folder,
                   const OutputOptions& options) {
    if (result.scene.points.x.size() != result.scene.points.primitive.size()) {
        throw Error(ErrorKind::usage,
                    "the result has no coordinates of its points: call add_coordinates() first");
    }
    io::OutputFolder out(folder);
    const auto points = [&] { write_points(out.folder() / "points.ply", result); };
    // Both are long, and neither needs the other.
    std::future<void> beside;
    if (options.threads != 1) {
        beside = std::async(std::launch::async, points);
    } else {
        points();
    }
    write_all_else(out.folder(), result, options);
    if (beside.valid()) beside.get();
    out.commit();
    if (result.tiled) result.tiled->finished();
}

}  // namespace topple
