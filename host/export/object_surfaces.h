// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/boundary_cells.h"
#include "core/object_surface.h"
#include "core/solid_cells.h"
#include "topple/scene.h"
#include "vdb/voxel_scene.h"

namespace topple {

// How fine surfaces are: as the scan was, for looking at it; or as coarse as looks well when it
// moves.
enum class SurfaceDetail : std::uint8_t { shown, simulated };

// The surfaces of a scene's objects, ascending, that of what belongs to none first; coloured as far
// as the scan is. cells: sorted. boundary: what bounds them within voxels, or nothing.
// threads: 0 for as many as the machine has.
std::vector<ObjectSurface> object_surfaces(const Scene& scene, const SolidCells& cells,
                                           const BoundaryCells& boundary,
                                           const vdb::VoxelFrame& frame, unsigned threads,
                                           SurfaceDetail detail = SurfaceDetail::shown);

}  // namespace topple
