// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "topple/scene.h"

namespace topple::cli {

// The energy landscapes of an object as one picture, .svg or else PNG. Throws Error(input) where it
// can't be written.
void draw_landscape(const Scene& scene, const Object& object, const std::filesystem::path& path);

}  // namespace topple::cli
