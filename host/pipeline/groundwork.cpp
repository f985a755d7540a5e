// SPDX-License-Identifier: MIT
#include "pipeline/groundwork.h"

#include <utility>

#include "io/text.h"
#include "pipeline/budget.h"
#include "pipeline/parse_memory.h"
#include "pipeline/scale_checks.h"
#include "pipeline/solid_stage.h"
#include "pipeline/surface_extent.h"
#include "pipeline/voxel_size.h"

namespace topple {
namespace {

void check_memory_of(const CloudView& cloud, ScanOrigin origin, double voxel_m,
                     const ParseOptions& options) {
    if (options.max_memory_bytes == 0) return;
    const std::uint64_t need = one_piece_bytes(
        static_cast<double>(cloud.size()), extent_of(cloud).area_m2(), bounds_of(cloud), voxel_m);
    check_memory(std::to_string(cloud.size()) + " points at voxels of " +
                     io::short_number(voxel_m) + " m may need",
                 need, options,
                 std::string("use a larger ParseOptions::voxel_m") +
                     (origin == ScanOrigin::cloud_file
                          ? ", or ParseOptions::tile_m = 5 to have it parsed in blocks"
                          : ""));
}

// What find() makes. A scene that is too large for it is in another unit, perhaps, which is said.
template <class Find>
auto with_unit_hint(double extent_m, ScanOrigin origin, const Find& find) {
    try {
        return find();
    } catch (const Error& error) {
        const std::string hint = large_extent_hint(extent_m, origin);
        if (error.kind() != ErrorKind::input || hint.empty()) throw;
        throw Error(ErrorKind::input, hint + ", else: " + error.what());
    }
}

[[noreturn]] void no_surface(const Ingested& input, const std::string& source, double extent_m) {
    const std::string scale = of_frames(input.origin) && input.frames
                                  ? depth_scale_hint(*input.frames, input.origin)
                                  : small_extent_hint(extent_m, input.origin);
    throw Error(
        ErrorKind::input,
        source + ": " + io::counted(input.cloud.size(), "point") +
            (input.cloud.size() == 1 ? " was" : " were") +
            " found, but no surface of them fills the " + std::to_string(least_voxels) +
            " voxels that a solid takes; give a denser scan, or a smaller ParseOptions::voxel_m" +
            (scale.empty() ? "" : "; " + scale));
}

// The coordinates and colours of the points: moved, where they are the input's own.
void take_coordinates(Ingested& input, ScenePoints& out) {
    if (input.own.size() > 0) {
        out.x = std::move(input.own.x);
        out.y = std::move(input.own.y);
        out.z = std::move(input.own.z);
        out.red = std::move(input.own.red);
        out.green = std::move(input.own.green);
        out.blue = std::move(input.own.blue);
        return;
    }
    out.x.assign(input.cloud.x.begin(), input.cloud.x.end());
    out.y.assign(input.cloud.y.begin(), input.cloud.y.end());
    out.z.assign(input.cloud.z.begin(), input.cloud.z.end());
    const auto& [red, green, blue] = input.given_colours;
    out.red.assign(red.begin(), red.end());
    out.green.assign(green.begin(), green.end());
    out.blue.assign(blue.begin(), blue.end());
}

ScenePoints labelled_points(Ingested& input, const GeometryStage& geometry,
                            const VoxelStage& voxels) {
    ScenePoints out;
    out.index = std::move(input.index);
    out.primitive = numbered(geometry.primitive_of_point, voxels.number);
    out.region = geometry.region_of_point;
    const geometry::Surfels& s = geometry.surfels;
    for (auto* axis : {&out.nx, &out.ny, &out.nz}) axis->reserve(out.primitive.size());
    for (const std::uint32_t surfel : s.of_point) {
        out.nx.push_back(s.nx[surfel]);
        out.ny.push_back(s.ny[surfel]);
        out.nz.push_back(s.nz[surfel]);
    }
    return out;
}

}  // namespace

Groundwork lay_groundwork(device::Device& device, Ingested input, const ParseOptions& options,
                          const std::string& source, StageClock& stage) {
    Groundwork out;
    out.voxel_m = voxel_for_input(input, options);
    out.offset_m = input.own.offset_m;
    // What the input may mean else comes first: its unit, sides, colours, poses and up.
    out.notes = input.doubts;
    const double extent = extent_m({input.cloud.x, input.cloud.y, input.cloud.z});
    note_small_extent(extent, input.origin, out.notes);

    auto [geometry, voxels] = with_unit_hint(extent, input.origin, [&] {
        check_memory_of(input.cloud, input.origin, out.voxel_m, options);
        return find_solids(device, input, out.voxel_m, options, stage);  // 2
    });
    if (!geometry.frame.note.empty()) out.notes.push_back(geometry.frame.note);
    out.notes.insert(out.notes.end(), input.notes.begin(), input.notes.end());
    if (voxels.solids->primitives() == 0) no_surface(input, source, extent);
    out.parts = solid_parts(geometry, voxels);
    out.points = labelled_points(input, geometry, voxels);
    out.image_width = input.image_width;
    out.image_height = input.image_height;
    if (options.coordinates) take_coordinates(input, out.points);
    out.voxels = std::move(voxels.scene);
    out.weighed = weigh_parts(device, out.parts, options, stage);  // 4.2
    return out;
}

}  // namespace topple
