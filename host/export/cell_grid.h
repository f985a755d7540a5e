// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/solid_scene.h"

namespace topple::exports {

using Voxel = std::array<std::int32_t, 3>;

// The smallest box around voxels.
struct VoxelBox {
    Voxel low = filled(std::numeric_limits<std::int32_t>::max());
    Voxel high = filled(std::numeric_limits<std::int32_t>::min());

    void add(const Voxel& at) {
        for (std::size_t a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], at[a]);
            high[a] = std::max(high[a], at[a]);
        }
    }
    std::size_t layers(std::size_t axis) const {
        return static_cast<std::size_t>(high[axis] - low[axis]) + 1;
    }

  private:
    static Voxel filled(std::int32_t value) { return {value, value, value}; }
};

// A voxel that is a clump's, wholly or in part.
struct Cell {
    Voxel at{};
    std::size_t boundary = BoundaryCells::absent;

    bool whole() const { return boundary == BoundaryCells::absent; }
};

// The cells of a clump in the box around it, and which piece each belongs to.
class CellGrid {
  public:
    explicit CellGrid(std::vector<Cell> cells) : cells_(std::move(cells)) {
        VoxelBox box;
        for (const Cell& cell : cells_) box.add(cell.at);
        low_ = box.low;
        for (std::size_t a = 0; a < 3; ++a) size_[a] = box.layers(a);
        piece_.assign(size_[0] * size_[1] * size_[2], -1);
        index_.assign(piece_.size(), 0);
        for (std::size_t n = 0; n < cells_.size(); ++n)
            index_[place(cells_[n].at)] = static_cast<std::uint32_t>(n);
    }

    const std::vector<Cell>& cells() const { return cells_; }
    const Cell& operator[](std::size_t n) const { return cells_[n]; }
    // The cell at a voxel that is one's.
    const Cell& at(const Voxel& voxel) const { return cells_[index_[place(voxel)]]; }

    bool is(std::int32_t piece, const Voxel& voxel) const {
        return inside(voxel) && piece_[place(voxel)] == piece;
    }
    void mark(std::size_t cell, std::int32_t piece) { piece_[place(cells_[cell].at)] = piece; }

  private:
    std::size_t place(const Voxel& at) const {
        return (static_cast<std::size_t>(at[0] - low_[0]) * size_[1] +
                static_cast<std::size_t>(at[1] - low_[1])) *
                   size_[2] +
               static_cast<std::size_t>(at[2] - low_[2]);
    }
    bool inside(const Voxel& at) const {
        for (std::size_t a = 0; a < 3; ++a)
            if (at[a] < low_[a] || at[a] >= low_[a] + static_cast<std::int32_t>(size_[a]))
                return false;
        return true;
    }

    std::vector<Cell> cells_;
    Voxel low_{};
    std::array<std::size_t, 3> size_{};
    std::vector<std::int32_t> piece_;   // by voxel of the box
    std::vector<std::uint32_t> index_;  // of the cell there
};

}  // namespace topple::exports
