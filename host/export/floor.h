// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "export/body.h"

namespace topple::exports {

// Widens a level floor until it reaches under everything that begins little above it: under
// furniture and at walls a floor is hidden, and a hull of what was seen ends there.
void widen_floor(ConvexPart& floor, const std::vector<Body>& bodies, double voxel_m);

// A place on a floor where nothing stands, and nothing hangs lower than a person is tall.
struct FreePlace {
    Vec3 at{};            // on the floor's top
    double radius_m = 0;  // nothing is nearer, seen from above
};

// The middle of the widest one, to within a tenth of a metre, of where the floor was seen; nothing
// where there is none. Parts count as the boxes around them. floor: a level slab, with its solid.
std::optional<FreePlace> free_place(const ConvexPart& floor, const std::vector<Body>& bodies);

}  // namespace topple::exports
