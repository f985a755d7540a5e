// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/hidden_walls.h"
#include "solids/solid_parts.h"

namespace topple {

// Walls of which parts were seen go on behind the objects that stand before them: from a seen part
// on, along a row of things whose far sides nobody saw.
//   fixed  by primitive, whether it is the building's or of what is fixed to it
physics::HiddenWalls find_hidden_walls(const SolidParts& parts,
                                       std::span<const std::int32_t> object_of_primitive,
                                       const std::vector<bool>& fixed);

}  // namespace topple
