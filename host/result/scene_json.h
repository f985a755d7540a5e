// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "core/json.h"
#include "io/open_file.h"
#include "topple/scene.h"

// scene.json, schema "topple.scene/1": all of a Scene but its points, voxels and fields. A number
// that is not finite is written as null and read back as NaN; text that is no UTF-8 is mended.
namespace topple::io {

std::string scene_json(const Scene& scene);
// The same before it is written; its text may have to be mended yet.
OrderedJson scene_document(const Scene& scene);

// Throws Error(input) where the file can't be written.
void write_scene_json(const std::filesystem::path& file, const Scene& scene);

// Throws Error(input) naming the file and the member that is missing or of the wrong type.
Scene read_scene_json(const FileName& name);

}  // namespace topple::io
