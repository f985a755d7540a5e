// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/solid_scene.h"

namespace topple {

// Of each of so many objects the size of its box along the grid's axes, metres: from end to end of
// what of it is solid, within voxels as far as what bounds it there is known, else to a voxel.
// object_of_primitive: -1 for none.
std::vector<Vec3> object_sizes_m(const SolidScene& solids,
                                 std::span<const std::int32_t> object_of_primitive,
                                 std::size_t objects);

}  // namespace topple
