// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "safety/columns.h"
#include "safety/fall_zone.h"
#include "safety/human/human_field.h"
#include "safety/human/walkable_map.h"

namespace topple::safety {

// Half of a body's breadth, and as much sway: so near to a zone a walker is within its reach.
inline constexpr double passing_reach_m = 0.3;

// By zone: the share of the walks that pass within passing_reach_m of it, at heights that the body
// of a walker has there. What stands between both up to a walker's head keeps them apart: a wall.
// A walk counts once. Empty where nothing is walkable.
std::vector<double> passing_shares(const WalkableMap& map, const PrimaryMotion& motion,
                                   const Columns& columns, const HumanOptions& options,
                                   std::span<const FallZone> zones);

}  // namespace topple::safety
