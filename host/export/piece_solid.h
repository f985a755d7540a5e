// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/solid_scene.h"
#include "export/cell_grid.h"
#include "export/convex_part.h"

namespace topple::exports {

// The hull of what is solid of a piece, or nothing where that spans no volume, and how much it is.
struct PieceSolid {
    std::optional<ConvexPart> hull;
    double m3 = 0;
};

// What is solid within the cells of pieces of a clump: the exact border within each voxel. A piece
// is a number in the grid and the cells that have it.
class PieceSolids {
  public:
    PieceSolids(const SolidScene& solids, const CellGrid& grid)
        : solids_(solids), grid_(grid), corner_(grid.cells().size()) {}

    PieceSolid of(std::int32_t piece, std::span<const std::size_t> cells);
    // Cuts a piece's hull along its flat sides beyond which hardly any of its solid lies: faces are
    // as flat as they were seen, whatever single voxels stick out.
    void trim(std::span<const std::size_t> cells, ConvexPart& hull) const;
    // The flat surfaces that bound most of a piece's cells.
    std::vector<HalfSpace> flat_sides(std::span<const std::size_t> cells, std::size_t most) const;

  private:
    bool between_alike(std::size_t cell, std::int32_t piece) const;
    bool alike(const Cell& one, const Cell& other) const;
    void sample(std::span<const std::size_t> cells, double solid_m3, ConvexPart& part);
    void add_corners(std::size_t cell, std::vector<Vec3>& out);
    std::vector<Vec3> corners_of(const Cell& cell) const;

    const SolidScene& solids_;
    const CellGrid& grid_;
    std::vector<std::vector<Vec3>> corner_;  // of each cell's solid; found when first asked
};

}  // namespace topple::exports
