// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pipeline/geometry_stage.h"
#include "pipeline/ingest.h"
#include "pipeline/object_stage.h"
#include "pipeline/solid_parts.h"
#include "pipeline/stage_clock.h"
#include "vdb/voxel_scene.h"

// What a parse finds of a scan before it asks which parts are one object: sections 2 and 4.2 of the
// paper. Neither corrections nor disturbances, nor what is random, change it.
namespace topple {

struct Groundwork {
    double voxel_m = 0;
    Vec3 offset_m{};
    std::vector<std::string> notes;
    ScenePoints points;  // without their objects
    std::shared_ptr<vdb::VoxelScene> voxels;
    SolidParts parts;  // the seams, which joints alone ask for, are gone where it comes from a file
    PartStage weighed;
};

// source: of messages.
Groundwork lay_groundwork(device::Device& device, Ingested input, const ParseOptions& options,
                          const std::string& source, StageClock& stage);

}  // namespace topple
