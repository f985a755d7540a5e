// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/extents.h"
#include "core/solid_scene.h"

namespace topple::exports {

using Voxel = std::array<std::int32_t, 3>;

// How many layers of voxels a box around some has along an axis.
inline std::size_t layers_of(const Extents<std::int32_t>& box, std::size_t axis) {
    return static_cast<std::size_t>(std::int64_t{box.high[axis]} - box.low[axis]) + 1;
}

// A voxel that is a clump's, wholly or in part.
struct Cell {
    Voxel at{};
    std::size_t boundary = BoundaryCells::absent;

    bool whole() const { return boundary == BoundaryCells::absent; }
};

// The cells of a clump, which of them lie beside one another, and which piece each belongs to.
// Takes memory by their number, however far apart they lie.
class CellGrid {
  public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    // Throws Error(input) for cells that are strewn as those of no solid are.
    explicit CellGrid(std::vector<Cell> cells);

    const std::vector<Cell>& cells() const { return cells_; }
    const Cell& operator[](std::size_t n) const { return cells_[n]; }
    // The cell in the next voxel along an axis, upwards or downwards; or none.
    std::uint32_t beside(std::size_t cell, std::size_t axis, bool up) const {
        return beside_[2 * axis + up][cell];
    }
    // Whether a cell, or none, is a piece's.
    bool is(std::int32_t piece, std::uint32_t cell) const {
        return cell != none && piece_[cell] == piece;
    }
    void mark(std::size_t cell, std::int32_t piece) { piece_[cell] = piece; }

  private:
    std::vector<Cell> cells_;
    std::vector<std::int32_t> piece_;                   // by cell
    std::array<std::vector<std::uint32_t>, 6> beside_;  // by direction (-x, x, -y ..) and cell
};

}  // namespace topple::exports
