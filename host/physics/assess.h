// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "physics/support_rows.h"

// What one landscape and one footing say about a candidate.
namespace topple::physics {

// height: U over M g, metres, one value per direction of the mesh; down: the steepest neighbour of
// each, which is overwritten.
Stability assess(const SupportTable::Rows& rows, const Candidate& candidate,
                 std::span<const float> height, std::span<std::uint32_t> down, Passes passes);

}  // namespace topple::physics
