// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/boundary_cells.h"
#include "core/object_surface.h"
#include "core/solid_cells.h"
#include "topple/scene.h"
#include "vdb/voxel_scene.h"

namespace topple {

// The surfaces of a scene's objects, ascending, that of what belongs to none first; coloured as far
// as the scan is. cells: sorted. boundary: what bounds them within voxels, or nothing.
// threads: 0 for as many as the machine has.
std::vector<ObjectSurface> object_surfaces(const Scene& scene, const SolidCells& cells,
                                           const BoundaryCells& boundary,
                                           const vdb::VoxelFrame& frame, unsigned threads);

}  // namespace topple
