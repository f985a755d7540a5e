// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "topple/scene.h"

namespace topple::exports {

// Primitives of one object that become convex parts together.
struct Clump {
    std::int32_t object = -1;
    std::vector<std::int32_t> primitives;
    // What a part may hold beyond the solid.
    double slight_m3 = 0;
    bool ground = false;  // of what is fixed to the floor
};

// Each primitive by itself, but of objects that have many, those of a few voxels that lie near one
// another: what a scan shows of clutter and of far walls are hundreds of crumbs. Ascending by
// object.
std::vector<Clump> clumps_of(const Scene& scene, double voxel_m);

}  // namespace topple::exports
