// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "core/boundary_cells.h"
#include "core/thread_pool.h"
#include "solids/block_surface.h"
#include "solids/facets.h"
#include "solids/object_voxels.h"

namespace topple::solids {

// Where the vertices of an object's voxel faces belong: where the patches of their faces meet; what
// no patch tells of is smoothed. Grid frame, metres. facet: of each face.
std::vector<Vec3> vertex_places(std::span<const ObjectVoxel> voxels, const BlockSurface& surface,
                                std::span<const Facet> facet, const ObjectEntries& entries,
                                std::span<const SurfacePatch> patches, ThreadPool& pool);

}  // namespace topple::solids
