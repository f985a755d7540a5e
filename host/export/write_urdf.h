// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "export/sim_scene.h"

namespace topple::exports {

// Writes the scene as URDF, as scene.urdf in a folder: one tree, of which each body is a link at a
// joint to `world`, floating or fixed. And each body by itself, as scene_urdf/object_ID.urdf, for
// simulators that know no floating joints. Replaces an earlier export, see ExportFolder. Throws
// Error(input).
void write_urdf(const std::filesystem::path& folder, const SimScene& scene);

}  // namespace topple::exports
