// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/boundary_cells.h"
#include "core/thread_pool.h"
#include "solids/facets.h"
#include "solids/object_voxels.h"

// Dual contouring (Ju et al. 2002) of objects, so that faces are flat, edges sharp and tubes round
// as far as patches are known. Grid frame, metres.
//
// The surface has the topology of the sides of all voxels that hold more than a sliver of the
// object: so nothing is lost that is thinner than a voxel, and what lies between the object's own
// primitives is no surface. Each of these sides belongs to the patch through which one leaves the
// object there; each vertex lies where the patches of its sides meet. Where no patch is known,
// vertices are smoothed, by half a voxel at most.
namespace topple::solids {

// Closed: each edge has two triangles that walk it in opposite directions.
struct SurfaceMesh {
    std::vector<Vec3> vertex;
    // Of each vertex: the voxel corner that it comes from.
    std::vector<std::array<std::int32_t, 3>> corner;
    // Counter-clockwise seen from outside. Some have no area: what a plane cuts off a voxel may.
    std::vector<std::array<std::uint32_t, 3>> triangle;
    std::vector<Facet> facet;  // of each triangle
};

// voxels: of one object, sorted by (i, j, k).
SurfaceMesh surface_mesh(std::span<const ObjectVoxel> voxels, const BoundaryCells& boundary,
                         std::span<const std::int32_t> object_of_primitive, double voxel_m,
                         ThreadPool& pool);

}  // namespace topple::solids
