// SPDX-License-Identifier: MIT
#include "pipeline/voxel_stage.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "device/native/thread_pool.h"
#include "geometry/ledges.h"
#include "pipeline/view_coverage.h"

namespace topple {
namespace {

// Frames are carved in batches of this many bytes of depth, so that any number of them fits.
constexpr std::uint64_t batch_bytes = 16u << 20;

// Hidden gaps up to this long are taken for joints: what occlusion and dropped edge pixels leave
// open.
constexpr unsigned hidden_gap_voxels = 3;

// Primitives that are solids, by their voxels.
std::vector<bool> solids(const vdb::VoxelScene& scene, std::size_t primitives) {
    std::vector<std::uint64_t> voxels(primitives, 0);
    for (const std::int32_t p : scene.solid_cells().primitive) {
        if (p >= 0) ++voxels[static_cast<std::size_t>(p)];
    }
    std::vector<bool> keep;
    for (const std::uint64_t count : voxels) keep.push_back(count >= least_voxels);
    return keep;
}

// The k of the voxels in which most of the lowest storey's floor lies; the lowest number where
// there is no floor.
std::int32_t floor_level(const vdb::VoxelScene& scene, const GeometryStage& geometry) {
    const std::vector<geometry::Structure>& structure = geometry.shell.structure;
    const double top = (geometry.storeys.empty() ? std::numeric_limits<double>::infinity()
                                                 : geometry.storeys.front().top_m) /
                       scene.frame().voxel_m;
    const vdb::SolidCellArrays cells = scene.solid_cells();
    std::vector<std::int32_t> k;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t p = cells.primitive[n];
        if (p >= 0 && structure[static_cast<std::size_t>(p)] == geometry::Structure::floor &&
            cells.k[n] < top)
            k.push_back(cells.k[n]);
    }
    if (k.empty()) return std::numeric_limits<std::int32_t>::min();
    const auto middle = k.begin() + static_cast<std::ptrdiff_t>(k.size() / 2);
    std::nth_element(k.begin(), middle, k.end());
    return *middle;
}

std::vector<vdb::VoxelScene::StandsOn> ledges(const GeometryStage& geometry) {
    const Vec3& up = geometry.frame.axes[2];
    std::vector<vdb::VoxelScene::StandsOn> out;
    for (const geometry::Ledge& l :
         geometry::ledges_between(geometry.surfels, geometry.primitives, {up[0], up[1], up[2]}))
        out.push_back({l.above, l.below, l.height_m});
    return out;
}

// For each cell the unseen voxels right below it, up to what fits. What is below the shell is of no
// interest.
std::vector<std::uint8_t> unseen_below(const vdb::VoxelScene& scene,
                                       const physics::SolidCells& cells,
                                       const std::vector<geometry::Structure>& structure) {
    std::vector<std::uint8_t> out(cells.size(), 0);
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t p = cells.primitive[n];
        if (p < 0 || structure[static_cast<std::size_t>(p)] != geometry::Structure::none) continue;
        const bool covered = n > 0 && cells.i[n - 1] == cells.i[n] &&
                             cells.j[n - 1] == cells.j[n] && cells.k[n - 1] == cells.k[n] - 1;
        if (covered) continue;
        while (out[n] < 255 && scene.state_at(cells.i[n], cells.j[n], cells.k[n] - out[n] - 1) ==
                                   vdb::State::invisible)
            ++out[n];
    }
    return out;
}

// Returns whether the frames show the scene from around.
bool carve_all(device::Device& device, const FrameStream& frames, vdb::VoxelScene& scene,
               StageClock& stage) {
    ViewCoverage coverage(scene.frame().grid_from_input);
    const Intrinsics& k = frames.intrinsics();
    const std::uint64_t frame_bytes = std::uint64_t{2} * k.width * k.height;
    const std::size_t per_batch =
        static_cast<std::size_t>(std::clamp<std::uint64_t>(batch_bytes / frame_bytes, 1, 64));
    std::vector<DepthFrame> batch;
    for_each_frame(frames, device.threads(), [&](DepthFrame frame, std::size_t f) {
        batch.push_back(std::move(frame));
        coverage.add(batch.back().camera_to_world);
        if (batch.size() < per_batch && f + 1 < frames.size()) return;
        scene.carve(device, k, batch);
        batch.clear();
        stage.progress("carving", static_cast<double>(f + 1) / static_cast<double>(frames.size()));
    });
    return coverage.from_around();
}

}  // namespace

double voxel_for_cell(double cell_m) {
    constexpr std::array<double, 8> handy{0.005, 0.0075, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05};
    for (const double h : handy) {
        if (h >= 1.75 * cell_m) return h;
    }
    return 2 * cell_m;
}

VoxelStage make_solids(device::Device& device, const Ingested& input, GeometryStage& geometry,
                       double voxel_m, StageClock& stage) {
    VoxelStage out;
    const vdb::VoxelFrame frame{voxel_m, geometry.frame.axes};
    stage("voxels", [&] {
        out.scene =
            std::make_shared<vdb::VoxelScene>(frame, input.cloud, geometry.primitive_of_point);
    });
    bool around = false;
    stage("carving", [&] {
        if (input.frames) around = carve_all(device, *input.frames, *out.scene, stage);
        if (input.space) out.scene->set_free(*input.space);
    });
    stage("filling", [&] {
        vdb::VoxelScene::FillOptions options;
        options.columns = around;
        options.lowest = floor_level(*out.scene, geometry);
        for (const geometry::Structure s : geometry.shell.structure) {
            options.hollow.push_back(s == geometry::Structure::wall ||
                                     s == geometry::Structure::ceiling);
        }
        out.scene->fill(device, options);
        device.threads().poll();
        out.scene->settle(options.hollow, ledges(geometry));
        out.scene->extend(options.hollow);
        device.threads().poll();
        out.scene->bridge(hidden_gap_voxels, options.hollow);
        if (input.space) out.scene->set_solid(*input.space);
        device.threads().poll();
        out.scene->relabel(
            keep_primitives(geometry, solids(*out.scene, geometry.primitives.model.size())));
    });
    const vdb::SolidCellArrays solid = out.scene->solid_cells();
    out.cells.voxel_m = voxel_m;
    for (std::size_t n = 0; n < solid.size(); ++n) {
        if (!out.scene->in_bounds(solid.i[n], solid.j[n], solid.k[n])) continue;
        out.cells.i.push_back(solid.i[n]);
        out.cells.j.push_back(solid.j[n]);
        out.cells.k.push_back(solid.k[n]);
        out.cells.primitive.push_back(solid.primitive[n]);
        out.cells.surface.push_back(solid.state[n] == vdb::State::surface);
    }
    out.cells.unseen_below = unseen_below(*out.scene, out.cells, geometry.shell.structure);
    return out;
}

}  // namespace topple
