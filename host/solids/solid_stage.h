// SPDX-License-Identifier: MIT
#pragma once

#include "device/device.h"
#include "device/stage_clock.h"
#include "points/ingest.h"
#include "solids/geometry_stage.h"
#include "solids/voxel_stage.h"
#include "topple/parse.h"

// Section 2 of the paper: from points to primitives and their solids.
namespace topple {

struct SolidStage {
    GeometryStage geometry;
    VoxelStage voxels;
};

// Free space is carved beside the finding of primitives, where that is possible.
SolidStage find_solids(device::Device& device, const Ingested& input, double voxel_m,
                       const ParseOptions& options, StageClock& stage,
                       SolidDetail detail = SolidDetail::within_voxels);

}  // namespace topple
