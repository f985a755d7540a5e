// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/manhattan.h"
#include "geometry/surfels.h"

namespace topple {

// Surfels and how the scene lies: all that voxels have to wait for.
struct FramedSurfels {
    geometry::Surfels surfels;
    geometry::SceneFrame frame;
};

}  // namespace topple
