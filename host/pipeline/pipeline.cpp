// SPDX-License-Identifier: MIT
#include <cmath>
#include <utility>

#include "pipeline/assemble.h"
#include "pipeline/geometry_stage.h"
#include "pipeline/ingest.h"
#include "pipeline/object_stage.h"
#include "pipeline/safety_stage.h"
#include "pipeline/stage_clock.h"
#include "pipeline/voxel_stage.h"
#include "topple/parse.h"
#include "topple/version.h"

namespace topple {
namespace {

void check_positive(const char* option, double value, double highest) {
    if (value > 0 && value <= highest) return;  // false for NaN
    throw Error(ErrorKind::usage, std::string(option) + " " + std::to_string(value) +
                                      ": expected a number above 0 and at most " +
                                      std::to_string(highest));
}

void check(const ParseOptions& o) {
    if (o.voxel_m != 0) check_positive("--voxel", o.voxel_m, 1.0);
    check_positive("--density", o.density_kg_m3, 30000);
    check_positive("--friction", o.friction, 10);
    check_positive("--wind", o.wind_m_s, 150);
    check_positive("--pga", o.pga_m_s2, 50);
    for (const std::string& d : o.disturbances) {
        if (d != "human" && d != "wind" && d != "earthquake") {
            throw Error(ErrorKind::usage,
                        "--disturbance " + d + ": expected human, wind or earthquake");
        }
    }
}

// What the stages after ingest will hold at their peak, bytes: measured at about 400 per point
// (cloud, surfels, regions, output) and 40 per voxel of the scene's box.
std::uint64_t estimated_bytes(const PointCloud& cloud, double voxel_m) {
    double box = 1;
    for (const auto* axis : {&cloud.x, &cloud.y, &cloud.z}) {
        float low = INFINITY, high = -INFINITY;
        for (const float v : *axis) low = std::min(low, v), high = std::max(high, v);
        box *= (high - low) / voxel_m + 16;
    }
    return static_cast<std::uint64_t>(400.0 * static_cast<double>(cloud.size()) + 40.0 * box);
}

void check_memory(const PointCloud& cloud, double voxel_m, const ParseOptions& options) {
    if (options.max_memory_bytes == 0) return;
    const std::uint64_t need = estimated_bytes(cloud, voxel_m);
    if (need > options.max_memory_bytes) {
        throw Error(ErrorKind::input, std::to_string(cloud.size()) + " points at voxels of " +
                                          std::to_string(voxel_m) + " m would need about " +
                                          std::to_string(need >> 20) + " MiB, more than the " +
                                          std::to_string(options.max_memory_bytes >> 20) +
                                          " MiB of --max-memory; use a larger --voxel");
    }
}

ParseResult parse_ingested(device::Device& device, const Ingested& input,
                           const ParseOptions& options, Scene scene, StageClock& stage) {
    const double voxel_m = options.voxel_m > 0 ? options.voxel_m : voxel_for_cell(input.cell_m);
    check_memory(input.cloud, voxel_m, options);
    scene.topple_version = version;
    scene.backend = device::to_string(device.info().backend);
    scene.device = device.info().name;
    scene.seed = options.seed;
    scene.voxel_size_m = voxel_m;
    scene.density_kg_m3 = options.density_kg_m3;
    scene.friction = options.friction;
    scene.notes.insert(scene.notes.end(), input.notes.begin(), input.notes.end());

    GeometryStage geometry = find_primitives(device, input, options, stage);             // 2.1
    VoxelStage voxels = make_solids(device, input, geometry, voxel_m, stage);            // 2.2
    const ObjectStage objects = find_objects(device, geometry, voxels, options, stage);  // 3, 4
    const SafetyStage safety =
        assess_safety(device, geometry, voxels, objects, options, stage);  // 5
    stage("assembly", [&] { assemble(input, geometry, voxels, objects, safety, scene); });
    return {std::move(scene), std::move(voxels.scene)};
}

template <class Ingest>
ParseResult run(device::Device& device, const std::string& source, const ParseOptions& options,
                Ingest ingest_input) {
    check(options);
    // The clock writes into a list of its own: the scene moves while stages are still running.
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, options);
    const Ingested input = stage("ingest", ingest_input);
    Scene scene;
    scene.source = source;
    ParseResult result = parse_ingested(device, input, options, std::move(scene), stage);
    result.scene.timings_s = std::move(timings);
    return result;
}

}  // namespace

ParseResult parse(device::Device& device, const std::filesystem::path& input,
                  const ParseOptions& options) {
    return run(device, input.string(), options, [&] { return ingest(input, options); });
}

ParseResult parse(device::Device& device, const PointCloud& cloud, const ParseOptions& options) {
    return run(device, cloud.source, options, [&] { return ingest_cloud(cloud, options); });
}

}  // namespace topple
