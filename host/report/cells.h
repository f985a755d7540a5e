// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "topple/input.h"

namespace topple::report {

// One cube of the view: a voxel, or several merged.
struct Cell {
    std::array<std::int32_t, 3> index{};
    std::uint16_t group = 0;
    bool background = false;  // the ground, or no object's
    bool completed = false;
    std::uint8_t exposed = 0;  // faces with no cell behind them: bits -x +x -y +y -z +z
    std::array<float, 3> normal{};
};

// Finds a cell by its index: a dense array for each block of 8 x 8 x 8 cells that has any, since
// whoever asks for one asks for those beside it. The blocks are found by open addressing; it
// answers membership only, so its order reaches nothing.
class CellTable {
  public:
    CellTable();
    // The slot's value, `absent` where there is none. Indices must be within +-2^20.
    static constexpr std::uint32_t absent = UINT32_MAX;
    std::uint32_t find(const std::array<std::int32_t, 3>& index) const;
    // The value stored for the index, after storing `value` where there was none.
    std::uint32_t insert(const std::array<std::int32_t, 3>& index, std::uint32_t value);

  private:
    static constexpr std::size_t block_cells = 512;
    std::size_t slot_of(std::uint64_t key) const;
    void grow();
    std::vector<std::uint64_t> keys_;    // of blocks
    std::vector<std::uint32_t> blocks_;  // of each key: its place among
    std::vector<std::uint32_t> values_;  // block_cells each
    int shift_;                          // of a hash, to as many bits as the tables have slots
};

// The six cells that share a face with one, in the order of Cell::exposed.
std::array<std::array<std::int32_t, 3>, 6> beside(const std::array<std::int32_t, 3>& index);

// Calls call(number) for each of them that there is, by what the table has of it.
template <class Call>
void each_beside(const std::array<std::int32_t, 3>& index, const CellTable& table,
                 const Call& call) {
    for (const auto& near : beside(index)) {
        const std::uint32_t other = table.find(near);
        if (other != CellTable::absent) call(other);
    }
}

// Marks which faces of each cell are exposed; returns how many cells have one.
std::size_t mark_exposed(std::vector<Cell>& cells, const CellTable& table);

// Makes normals unit vectors. Gives background cells without a normal the mean of their
// neighbours', ring after ring. Those that no ring reached are returned, by number, ascending.
std::vector<std::uint32_t> spread_normals(std::vector<Cell>& cells, const CellTable& table);

}  // namespace topple::report
