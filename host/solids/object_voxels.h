// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/boundary_cells.h"
#include "core/solid_cells.h"

namespace topple::solids {

// A voxel in which an object, a set of primitives, is solid.
struct ObjectVoxel {
    std::int32_t object = -1;
    std::int32_t primitive = -1;  // the one of it that fills most
    Place at{};
    // The entries of BoundaryCells there, of whichever objects.
    std::uint32_t first = 0, last = 0;
    bool cell = false;    // a cell of one of the object's primitives
    bool whole = false;   // the boundary says nothing of it
    bool filled = false;  // more of it is solid than a sliver
};

// Of a primitive; -1 where it is none, or the span ends.
inline std::int32_t object_of(std::int32_t primitive,
                              std::span<const std::int32_t> object_of_primitive) {
    const auto p = static_cast<std::size_t>(primitive);
    return primitive >= 0 && p < object_of_primitive.size() ? object_of_primitive[p] : -1;
}

// Where a layer of cells ends at a patch in its own back half, so that little of it is left, the
// layer behind is filled, too: the surface that was seen has no hole there.
//
// object_of_primitive: -1 for none; cells of no primitive are object -1. Sorted by (object, i, j,
// k).
std::vector<ObjectVoxel> object_voxels(const SolidCells& cells, const BoundaryCells& boundary,
                                       std::span<const std::int32_t> object_of_primitive);

}  // namespace topple::solids
