// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/solid_scene.h"
#include "core/unseen.h"
#include "geometry/manhattan.h"
#include "geometry/surface_samples.h"
#include "geometry/surface_seams.h"
#include "solids/surfaces.h"
#include "solids/volume.h"

namespace topple {

// What is known of a scene once its surfaces are parts and its parts are solid, whether it was
// looked at in one piece or in blocks: all that objects, fields and advice are found from.
struct SolidParts {
    geometry::SceneFrame frame;
    std::vector<std::string> model;      // by primitive
    std::vector<double> shell_log_odds;  // by primitive, that it is the room's
    geometry::SurfaceSamples samples;    // sorted by primitive
    std::vector<std::uint64_t> points;   // by primitive
    geometry::SurfaceSeams seams;
    std::shared_ptr<const SolidScene> solids;
    // What sensors saw of it; null: nobody says where they were, or the scene is in blocks.
    std::shared_ptr<const vdb::VoxelScene> sensed;
};

// Of what sensors saw.
Unseen unseen_of(const SolidParts& parts);

// Of a scene in one piece.
SolidParts solid_parts(const Surfaces& geometry, const Volume& voxels);

}  // namespace topple
