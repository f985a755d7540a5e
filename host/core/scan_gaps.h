// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

// Empty voxels, along an axis, that scans leave where there are none. Set by hand.
namespace topple {

// Between two solids that touch: each surface may come to lie in the voxel next to its own.
inline constexpr unsigned contact_gap = 1;

// Where less was seen: below a foot, and where an edge hides how a thing goes on or depth readings
// at its rim were dropped. Beside contact_gap, a voxel on either side.
inline constexpr std::int32_t noise_gap = 3;

}  // namespace topple
