// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "export/sim_scene.h"

namespace topple::exports {

// Writes the scene as one file of USD as text, with the schemas of UsdPhysics: a prim
// /World/object_ID for each body, rigid where it may move; below it its surface, for renderers, and
// its parts, which collide. The file's name ends in .usda. An earlier export is replaced in one
// step. Throws Error(input): the file is another one's, or can't be written; Error(usage): its name
// ends otherwise.
void write_usd(const std::filesystem::path& file, const SimScene& scene);

}  // namespace topple::exports
