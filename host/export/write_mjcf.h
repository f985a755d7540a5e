// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "export/sim_scene.h"

namespace topple::exports {

// The scene in MuJoCo's format: a body `object_ID` for each object, free where it may move, and
// `pad_N` for each pad; a geom for each convex part, a box where it is one.
std::string mjcf(const SimScene& scene);

// Writes it as scene.xml into the folder, which is made where it is missing; an earlier export
// there is replaced in one step. Throws Error(input): the file is another one's, or can't be
// written.
void write_mjcf(const std::filesystem::path& folder, const SimScene& scene);

}  // namespace topple::exports
