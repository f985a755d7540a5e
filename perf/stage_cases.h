// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lab/scan/depth_camera.h"
#include "perf/kernels/measure.h"
#include "points/observation.h"
#include "solids/surfaces.h"
#include "vdb/voxel_scene.h"

// Whole stages, host and kernels together, on one generated room.
namespace topple::perf {

inline constexpr double stage_voxel_m = 0.02;

struct StageScene {
    // 40 frames of a walk through a room: 3.0 million rays. Poses are reckoned from where the
    // observation's coordinates are.
    scenes::Sequence sequence;
    Observation ingested;  // its fused cloud of 690,000 points, bare as a file would give it
    Surfaces geometry;     // what the stages below start from
};
StageScene make_stage_scene(device::Device& device);

// The names below, in their order.
std::vector<std::string> stage_names();

// "segmentation": normals, splitting and merging of the cloud, and each by itself as
// "segmentation/<stage>". "carving": surface voxels of the cloud, and all frames carved out of
// them. "filling": of what carving left; its bytes are those that its dispatches bind, each input
// and output once, so that its share of the roofline is that of the stage's whole wall time.
struct StageRun {
    std::vector<Result> results;
    std::vector<std::int32_t> label;  // primitive of each point
    std::unique_ptr<vdb::VoxelScene> carved;
};
StageRun measure_stages(device::Device& device, const StageScene& scene, unsigned runs);

}  // namespace topple::perf
