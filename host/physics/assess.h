// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "physics/support_rows.h"

// What one flooded landscape and one footing say about a candidate.
namespace topple::physics {

// The direction from which to flood. It is direction 0, the pose as scanned, but for a candidate
// whose footing holds it: contacts are known to a voxel or two, so that its hull may seem to rock
// by an angle within that; then it is the bottom of that dent.
std::uint32_t start_direction(const SupportTable::Rows& rows, const Candidate& candidate,
                              std::span<const float> height);

// height, level: U and L over M g, metres, one value per direction of the mesh.
Stability assess(const SupportTable::Rows& rows, const Candidate& candidate,
                 std::span<const float> height, std::span<const float> level, std::uint32_t start,
                 Passes passes);

}  // namespace topple::physics
