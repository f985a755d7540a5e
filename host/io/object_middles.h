// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "topple/scene.h"

namespace topple::io {

// The middle of each object's box along the room's axes (Scene::manhattan_from_input), to half a
// voxel: in the input's frame, metres; none for an object without solid voxels.
std::vector<std::optional<Vec3>> object_middles_m(const Scene& scene);

}  // namespace topple::io
