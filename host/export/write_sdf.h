// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "export/sim_scene.h"

namespace topple::exports {

// Writes the scene as SDF 1.7, which Gazebo reads, as scene.sdf in a folder: a world with a model
// for each body, static where it is fixed. Replaces an earlier export, see ExportFolder. Throws
// Error(input).
void write_sdf(const std::filesystem::path& folder, const SimScene& scene);

}  // namespace topple::exports
