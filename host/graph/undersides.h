// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/object_of.h"
#include "core/solid_cells.h"
#include "core/table.h"

namespace topple::graph {

// A column of an object's cells: where it ends below, and what is under it. Voxels.
struct Underside {
    std::int32_t i, j, k;    // the lowest cell
    std::int32_t gap;        // empty cells down to the next solid of another object; -1: none
    std::int32_t primitive;  // of that solid; -1: of none
    std::int32_t own;        // primitive of the lowest cell
    std::int32_t unseen;     // cells right below it that nobody saw into
};
// By object, sorted by (i, j, k).
Table<ObjectId, std::vector<Underside>> undersides(const SolidCells& cells, ObjectOf object_of,
                                                   std::size_t objects);

}  // namespace topple::graph
