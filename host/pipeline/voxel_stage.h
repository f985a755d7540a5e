// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "core/solid_scene.h"
#include "device/device.h"
#include "pipeline/geometry_stage.h"
#include "pipeline/ingest.h"
#include "pipeline/stage_clock.h"
#include "vdb/voxel_scene.h"

// Section 2.2 of the paper: from labelled points to solid voxels.
namespace topple {

struct VoxelStage {
    std::shared_ptr<vdb::VoxelScene> scene;
    std::shared_ptr<const SolidScene> solids;
};

// A solid has at least the volume of a cube of three voxels; less is a scrap that noise left, and
// too little to tell how it stands.
constexpr std::uint64_t least_voxels = 27;

// Edge of a solid voxel for a scan of this resolution: about two cells, rounded to a handy value.
double voxel_for_cell(double cell_m);

// Voxels, carving, filling and joining. Primitives too small to be solids are dropped from
// `geometry`; their points and voxels stay, unassigned.
VoxelStage make_solids(device::Device& device, const Ingested& input, GeometryStage& geometry,
                       double voxel_m, StageClock& stage);

}  // namespace topple
