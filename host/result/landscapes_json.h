// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "io/open_file.h"
#include "topple/scene.h"

namespace topple::io {

// The energy landscapes of the scene's objects as a file of its own, since they are large. Lengths
// and directions have four digits. Throws Error(input) naming the file where it can't be written.
void write_landscapes_json(const std::filesystem::path& file, const Scene& scene);

// Fills in the landscapes of the scene that was written with it. Throws Error(input) naming the
// file where it is missing, breaks the format or is not of this scene.
void read_landscapes_json(const FileName& name, Scene& scene);

}  // namespace topple::io
