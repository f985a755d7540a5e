// SPDX-License-Identifier: MIT
#include "perf/stage_cases.h"

#include <functional>
#include <utility>

#include "device/stage_clock.h"
#include "lab/rooms/furnished_room.h"
#include "vdb/completion.h"

namespace topple::perf {
namespace {

using Timings = std::vector<std::pair<std::string, double>>;

Surfaces segment(device::Device& device, const StageScene& scene, Timings& timings) {
    const ParseOptions options;
    StageClock clock(timings, options);
    return find_primitives(device, scene.ingested,
                           find_surfels(device, scene.ingested, options, clock), clock);
}

std::uint64_t hash_of(const vdb::VoxelScene& scene) {
    const vdb::Tiles tiles = scene.tiles(true);
    const std::vector<std::uint8_t> states = scene.states(tiles);
    Hash hash;
    for (const std::uint8_t state : states) hash.word(state);
    return hash.add(scene.primitives(tiles)).value();
}

std::vector<Result> measure_segmentation(device::Device& device, const StageScene& scene,
                                         unsigned runs, std::vector<std::int32_t>& label) {
    const Work work{static_cast<double>(scene.ingested.cloud.size()), "points", 0, 0};
    std::vector<Result> results{named(device, "segmentation", work)};
    for (const char* stage : {"normals", "splitting", "merging"})
        results.push_back(named(device, std::string("segmentation/") + stage, work));
    for (unsigned n = 0; n < runs; ++n) {
        const device::Counters before = device.counters();
        Timings timings;
        const Stopwatch watch;
        label = segment(device, scene, timings).primitive_of_point;
        results[0].add(watch.elapsed());
        if (n == 0) results[0].counters = device.counters() - before;
        for (const auto& [stage, seconds] : timings) {
            for (Result& r : results) {
                if (r.name == "segmentation/" + stage) r.samples_s.push_back(seconds);
            }
        }
    }
    results[0].hash = Hash().add(label).value();
    return results;
}

vdb::VoxelScene carve(device::Device& device, const StageScene& scene) {
    vdb::VoxelScene out({.voxel_m = stage_voxel_m}, scene.ingested.cloud,
                        scene.geometry.primitive_of_point);
    out.carve(device, scene.sequence.intrinsics, scene.sequence.frames);
    return out;
}

Result measure_carving(device::Device& device, const StageScene& scene, unsigned runs,
                       std::unique_ptr<vdb::VoxelScene>& carved) {
    double rays = 0;
    for (const DepthFrame& frame : scene.sequence.frames) {
        for (const std::uint16_t depth : frame.depth) rays += depth != 0;
    }
    Result result = named(device, "carving", {rays, "rays", 0, 0});
    sample(device, result, runs,
           [&] { carved = std::make_unique<vdb::VoxelScene>(carve(device, scene)); });
    result.hash = hash_of(*carved);
    return result;
}

Result measure_filling(device::Device& device, const StageScene& scene, unsigned runs) {
    vdb::VoxelScene carved = carve(device, scene);
    const vdb::FillOptions options{.roles = scene.geometry.role};
    Result result = named(device, "filling", {0, "voxels filled", 0, 0});
    sample(device, result, runs,
           [&] { result.work.items = static_cast<double>(vdb::fill(device, carved, options)); });
    result.work.bytes = static_cast<double>(result.counters.bytes_bound);
    result.hash = hash_of(carved);
    return result;
}

}  // namespace

StageScene make_stage_scene(device::Device& device) {
    scenes::CameraOptions camera;
    camera.frames = 40;
    camera.fuse_m = 0.0098;
    StageScene scene;
    scene.sequence = scenes::walk(scenes::furnished_room({.seed = 1}), camera);
    scene.ingested = observe_cloud(device, scene.sequence.cloud, {});
    for (DepthFrame& frame : scene.sequence.frames) {
        for (std::size_t a = 0; a < 3; ++a)
            frame.camera_to_world[4 * a + 3] -= scene.ingested.origin_m[a];
    }
    Timings ignored;
    scene.geometry = segment(device, scene, ignored);
    return scene;
}

std::vector<std::string> stage_names() {
    return {"segmentation",
            "segmentation/normals",
            "segmentation/splitting",
            "segmentation/merging",
            "carving",
            "filling"};
}

StageRun measure_stages(device::Device& device, const StageScene& scene, unsigned runs) {
    StageRun out;
    out.results = measure_segmentation(device, scene, runs, out.label);
    out.results.push_back(measure_carving(device, scene, runs, out.carved));
    out.results.push_back(measure_filling(device, scene, runs));
    return out;
}

}  // namespace topple::perf
