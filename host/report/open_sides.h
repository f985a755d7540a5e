// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "report/cells.h"

namespace topple::report {

// Gives the cells of the background numbered in `which` the normal of the side that a room lies on,
// told from the other cells of the background alone: a wall or ceiling faces what it sees across
// free space, and a floor faces up. A sheet with rooms on both of its sides faces both, one with a
// room on neither faces `centre` (cell units), or up. edge_m: of a cell. Voids of less than a metre
// are no rooms. `table` finds the cells.
void face_open_sides(std::vector<Cell>& cells, const CellTable& table,
                     std::span<const std::uint32_t> which, const std::array<double, 3>& centre,
                     double edge_m);

}  // namespace topple::report
