// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "core/solid_scene.h"
#include "io/open_file.h"

// solids.bin: the solids of a scene as finely as they are known, from which exports are made
// without another parse. Grid frame; the scene's manhattan_from_input leads there.
namespace topple::io {

// Throws Error(input) where the file can't be written.
void write_solids(const std::filesystem::path& file, const SolidScene& solids);

// Throws Error(input) that names the file where it is missing, damaged, or of another version.
std::shared_ptr<const SolidScene> read_solids(const FileName& name);

}  // namespace topple::io
