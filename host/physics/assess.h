// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/support_rows.h"

// What one landscape and one footing say about a candidate.
namespace topple::physics {

// height: U over M g, metres, one value per direction of the mesh; down: the steepest neighbour of
// each, which is overwritten.
Stability assess(const SupportTable::Rows& rows, const Candidate& candidate,
                 std::span<const float> height, std::span<std::uint32_t> down, Passes passes);

// Fills in what follows from the ways, of which there is one at least: all but its margin and the
// ways themselves. Climbs within alike_m are equal.
void weigh_ways(const std::vector<TippingWay>& ways, double weight_N, double alike_m,
                Stability& result);

}  // namespace topple::physics
