// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "topple/scene.h"

namespace topple {

// What a scene.json must keep to, so that others can go by its ids and figures: a file says
// anything. Throws Error(input) that names the file.
void check_scene(const Scene& scene, const std::filesystem::path& file);

}  // namespace topple
