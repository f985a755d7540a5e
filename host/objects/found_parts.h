// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "objects/object_stage.h"
#include "solids/solid_parts.h"
#include "vdb/voxel_scene.h"

// What a parse finds of a scan before it asks which parts are one object: sections 2 and 4.2 of the
// paper. Neither corrections nor disturbances, nor what is random, change it.
namespace topple {

struct FoundParts {
    double voxel_m = 0;
    Vec3 offset_m{};
    std::vector<std::string> notes;
    ScenePoints points;                               // without their objects
    std::uint32_t image_width = 0, image_height = 0;  // as in ParseResult
    std::shared_ptr<vdb::VoxelScene> voxels;
    SolidParts parts;  // the seams, which joints alone ask for, are gone where it comes from a file
    PartStage weighed;
};

}  // namespace topple
