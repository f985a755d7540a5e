// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "device/device.h"
#include "pipeline/object_stage.h"
#include "pipeline/stage_clock.h"
#include "safety/fields.h"

// Section 5 of the paper: what may disturb the objects, and what that risks. Grid frame.
namespace topple {

struct SafetyStage {
    std::vector<safety::Disturbance> disturbances;
    std::vector<std::vector<safety::Risk>> risk;  // by disturbance, then by object
    std::vector<double> unsafety;                 // by object, 1 to 10
};

SafetyStage assess_safety(device::Device& device, const GeometryStage& geometry,
                          const VoxelStage& voxels, const ObjectStage& objects,
                          const ParseOptions& options, StageClock& stage);

}  // namespace topple
