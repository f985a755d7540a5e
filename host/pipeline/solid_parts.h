// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/manhattan.h"
#include "geometry/shell.h"
#include "geometry/surface_samples.h"
#include "graph/surface_seams.h"
#include "physics/bodies.h"
#include "pipeline/geometry_stage.h"
#include "pipeline/voxel_stage.h"

namespace topple {

// What is known of a scene once its surfaces are parts and its parts are solid, whether it was
// looked at in one piece or in blocks: all that objects, fields and advice are found from.
struct SolidParts {
    geometry::SceneFrame frame;
    std::vector<std::string> model;  // by primitive
    geometry::Shell shell;
    geometry::SurfaceSamples samples;   // sorted by primitive
    std::vector<std::uint64_t> points;  // by primitive
    graph::SurfaceSeams seams;
    physics::SolidCells cells;  // grid frame
};

// Of a scene in one piece. Takes the cells from the stage.
SolidParts solid_parts(const GeometryStage& geometry, VoxelStage& voxels);

}  // namespace topple
