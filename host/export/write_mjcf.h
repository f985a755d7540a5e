// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "export/sim_scene.h"

namespace topple::exports {

// Writes the scene in MuJoCo's format, as scene.xml in a folder: a body `object_ID` for each
// object, free where it may move, and `pad_N` for each pad; a geom for each convex part, a box,
// cylinder or sphere where it is one; and one that collides with nothing for what is seen. Replaces
// an earlier export, see ExportFolder. Throws Error(input).
void write_mjcf(const std::filesystem::path& folder, const SimScene& scene);

}  // namespace topple::exports
