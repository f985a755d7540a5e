// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/geometry_stage.h"
#include "pipeline/ingest.h"
#include "pipeline/object_stage.h"
#include "pipeline/safety_stage.h"
#include "pipeline/voxel_stage.h"
#include "topple/scene.h"

namespace topple {

// Gathers what the stages found into the public result, in the input's frame, and hands the objects
// and fields to the voxel grids.
void assemble(const Ingested& input, const GeometryStage& geometry, VoxelStage& voxels,
              const ObjectStage& objects, const SafetyStage& safety, Scene& scene);

}  // namespace topple
