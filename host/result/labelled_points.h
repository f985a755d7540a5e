// SPDX-License-Identifier: MIT
#pragma once

#include "points/observation.h"
#include "solids/surfaces.h"
#include "solids/volume.h"
#include "topple/scene.h"

namespace topple {

// The input's points with the region and solid that each belongs to, and where they lie if that is
// asked for: moved, where the coordinates are the input's own.
ScenePoints labelled_points(Observation& input, const Surfaces& geometry, const Volume& voxels,
                            bool coordinates);

}  // namespace topple
