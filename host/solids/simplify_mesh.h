// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "core/boundary_cells.h"
#include "core/thread_pool.h"
#include "solids/surface_mesh.h"

namespace topple::solids {

struct SimplifyOptions {
    double tolerance_m = 0;  // how far a vertex may be from the planes of the triangles it replaces
    double longest_m = 0;    // edges become no longer than that; 0: any length
};

// The same surface of fewer triangles: vertices are merged into neighbours while the error quadrics
// (Garland and Heckbert 1997) allow it. Those that stay keep their places, so that edges stay sharp
// and corners where they are; the mesh stays closed, and borders between primitives stay. The same
// for any number of threads.
void simplify(SurfaceMesh& mesh, std::span<const SurfacePatch> patches,
              const SimplifyOptions& options, ThreadPool& pool);

}  // namespace topple::solids
