// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/cell_grid.h"
#include "solids/error_quadric.h"
#include "solids/surface_mesh.h"

namespace topple::solids {

// A block's part of a mesh.
struct MeshPiece {
    SurfaceMesh mesh;
    std::vector<ErrorQuadric> quadric;  // of each vertex
    std::vector<std::uint8_t> fixed;    // of each vertex: other pieces have it, too
    std::vector<std::uint8_t> settled;  // of each vertex: 1 where nothing is left to be done
    std::vector<std::uint32_t> from;    // of each vertex: which one of the whole, ascending
};

// Cuts a mesh into blocks that fit a cache and may be worked on at once, and joins them again. What
// they are depends on the mesh alone, which must outlive them.
class MeshPieces {
  public:
    explicit MeshPieces(const SurfaceMesh& mesh);
    std::size_t size() const { return blocks_.size(); }

    // quadric: of each vertex of the whole. number: one of each vertex, 0 as it comes and goes.
    MeshPiece cut(std::size_t block, std::span<const ErrorQuadric> quadric,
                  std::vector<std::uint32_t>& number) const;
    // The mesh that the pieces are now. quadric: on entry as for cut(), then of its vertices, as
    // settled becomes.
    SurfaceMesh joined(std::span<const MeshPiece> pieces, std::vector<ErrorQuadric>& quadric,
                       std::vector<std::uint8_t>& settled) const;

  private:
    const SurfaceMesh& mesh_;
    geometry::KeyGroups blocks_;        // triangles
    std::vector<std::uint8_t> shared_;  // of each vertex: by several blocks
};

}  // namespace topple::solids
