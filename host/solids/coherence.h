// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/solid_cells.h"
#include "solids/combine.h"

namespace topple::solids {

using BorderKey = std::pair<Place, std::int32_t>;  // a voxel and a primitive

// A voxel that may be on a primitive's border.
struct BorderVoxel {
    Place at;
    std::int32_t primitive;
    bool own = false;      // one of the primitive's cells
    bool extends = false;  // the primitive goes on into it
    BorderKey key() const { return {at, primitive}; }
};

// What hangs together is solid; what patches cut off from what was seen is not. In all of these
// `sums` says what bounds each of `voxels`, which are sorted by key.

// By cell, whether patches say that nothing of it is solid.
std::vector<bool> air_by_patches(const SolidCells& cells, std::span<const BorderVoxel> voxels,
                                 std::span<const Combination> sums);

// What was completed is solid where it hangs together with what was seen of its primitive: beyond
// the seen surface, cells that hide in a corner of it are air. Marks them, too, and returns them,
// sorted.
std::vector<BorderVoxel> cut_off(const SolidCells& cells, std::vector<bool>& air);

// By voxel, whether it is no cell of the primitive's and hangs on none either: what a patch reaches
// beyond cells that are air.
std::vector<bool> out_of_reach(const SolidCells& cells, std::span<const BorderVoxel> voxels,
                               std::span<const Combination> sums, const std::vector<bool>& air);

}  // namespace topple::solids
