// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "device/device.h"
#include "graph/contact_graph.h"
#include "graph/stable_objects.h"
#include "physics/bodies.h"
#include "physics/landscape.h"
#include "physics/sliding.h"
#include "pipeline/geometry_stage.h"
#include "pipeline/stage_clock.h"
#include "pipeline/voxel_stage.h"

// Sections 3 and 4 of the paper: from solid primitives to stable objects. Grid frame.
namespace topple {

// One object: a group of primitives, or the ground with all that is fixed to it.
struct StableObject {
    physics::Candidate candidate;
    bool grounded = false;
    physics::SlideResult sliding;
    physics::Instability instability;  // of tipping and sliding together
    double lowest_m = 0, highest_m = 0;
};

struct ObjectStage {
    std::vector<physics::Body> bodies;  // by primitive
    graph::ContactGraph contacts;
    graph::Grouping grouping;
    std::vector<std::int32_t> object_of_primitive;  // the ground, where there is one, is object 0
    std::vector<StableObject> objects;
};

ObjectStage find_objects(device::Device& device, const GeometryStage& geometry,
                         const VoxelStage& voxels, const ParseOptions& options, StageClock& stage);

}  // namespace topple
