// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "core/boundary_cells.h"
#include "core/thread_pool.h"
#include "solids/surface_mesh.h"

namespace topple::solids {

// Splits edges whose middle lies off the curved patches that meet there, so that things of a few
// voxels are round, too; the new vertices lie on the patches. Stays closed.
void refine(SurfaceMesh& mesh, std::span<const SurfacePatch> patches, double voxel_m,
            ThreadPool& pool);

}  // namespace topple::solids
