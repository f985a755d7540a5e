// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solids/surface_mesh.h"

namespace topple::solids {

// A mesh with a normal for each vertex. Where surfaces meet at a crease, several vertices lie in
// one place.
struct ShadedMesh {
    std::vector<Vec3> vertex, normal;
    std::vector<std::uint32_t> from;  // of each vertex: which one of the mesh that was shaded
    std::vector<std::array<std::uint32_t, 3>> triangle;
};

// Normals are the patches' own, else the triangles'; what turns by less than the angle of a crease
// shares them.
ShadedMesh shaded(const SurfaceMesh& mesh, std::span<const SurfacePatch> patches);

}  // namespace topple::solids
