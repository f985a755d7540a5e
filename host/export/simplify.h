// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "export/convex_part.h"

namespace topple::exports {

// As many corners as physics engines take of one convex mesh: PhysX's limit.
inline constexpr std::size_t most_corners = 64;

// Finer than what was measured.
inline constexpr double fine_voxels = 0.05;

// The part with fewer corners, all of them its own: those within `tolerance_m` of the hull of the
// others are left out, and where more than most_corners are left then, the ones that stick out
// least. Its extent along the axes is kept.
ConvexPart simplified(ConvexPart part, double tolerance_m);

}  // namespace topple::exports
