// SPDX-License-Identifier: MIT
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

}  // namespace

void write_outputs(const ParseResult& result, const std::filesystem::path& folder,
                   const OutputOptions& options) {
    if (result.scene.points.x.size() != result.scene.points.primitive.size()) {
        throw Error(ErrorKind::usage,
                    "the result has no coordinates of its points: call add_coordinates() first");
    }
    io::OutputFolder out(folder);
    if (result.tiled) {
        result.tiled->write_points(out.folder() / "points.ply");
    } else {
        io::write_points_ply(out.folder() / "points.ply", result.scene.points);
    }
    const auto voxels = result.tiled
                            ? std::make_shared<const vdb::VoxelScene>(result.tiled->load_voxels())
                            : result.voxels;
    voxels->write(out.folder() / "volume.vdb");
    io::write_solid_ply(out.folder() / "solid.ply", result.scene.solid);
    report::write_report(out.folder() / "report.html", result.scene);
    if (options.pictures) report::write_pictures(out.folder(), result.scene);
    if (options.glb) write_objects_glb(out.folder() / "objects.glb", result.scene, *voxels);
    if (options.octomap) write_map(out.folder() / "map.bt", *voxels);
    io::write_landscapes_json(out.folder() / "landscapes.json", result.scene);
    io::write_scene_json(out.folder() / "scene.json", result.scene);
    out.commit();
    if (result.tiled) result.tiled->finished();
}

}  // namespace topple
