// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "export/body.h"

namespace topple::exports {

// Widens a level floor until it reaches under everything that begins little above it: under
// furniture and at walls a floor is hidden, and a hull of what was seen ends there.
void widen_floor(ConvexPart& floor, const std::vector<Body>& bodies, double voxel_m);

}  // namespace topple::exports
