// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include "objects/found_parts.h"
#include "objects/object_stage.h"
#include "safety/safety_stage.h"
#include "solids/solid_parts.h"
#include "topple/scene.h"

namespace topple {

// Notes what is parsed with what: version, device, options and voxel size.
void record_run(const device::Device& device, const ParseOptions& options, double voxel_m,
                Scene& scene);

// What to say of a density that is that of nothing, as in another unit; "" of others.
std::string light_density_note(double density_kg_m3);

// Gathers what was found of primitives, objects and fields into the public result, in the input's
// frame.
void assemble_objects(const SolidParts& parts, const ObjectStage& objects,
                      const SafetyStage& safety, Scene& scene);

// The fields over space, by disturbance, in the input's frame; they are taken out of `safety`.
std::map<std::string, SpaceField> take_space_fields(const SolidParts& parts, SafetyStage& safety);

// Each field's strength at the solid voxels it acts on, for volume.vdb.
void add_exposures(const SafetyStage& safety, const SolidCells& cells, vdb::VoxelScene& voxels);

// Adds the points and the solid voxels, and hands objects and fields to the voxel grids.
void assemble_points(FoundParts found, const ObjectStage& objects, const SafetyStage& safety,
                     Scene& scene);

}  // namespace topple
