// SPDX-License-Identifier: MIT
#pragma once

#include "points/ingest.h"
#include "solids/geometry_stage.h"
#include "solids/voxel_stage.h"
#include "topple/scene.h"

namespace topple {

// The input's points with the region and solid that each belongs to, and where they lie if that is
// asked for: moved, where the coordinates are the input's own.
ScenePoints labelled_points(Ingested& input, const GeometryStage& geometry,
                            const VoxelStage& voxels, bool coordinates);

}  // namespace topple
