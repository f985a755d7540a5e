// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "lab/solids/scene.h"

namespace topple::scenes {

// The truth about a scene as JSON: seed, tilt (3x3), room, parts (id, kind, center, size, yaw,
// top_ratio, object, name, volume; lean, rounding, profile where there are such), objects (id,
// name, where), fixed and support as pairs of part ids. Kinds: box, rounded, cyl, lying, sph, cone,
// revolved. Throws Error(input) where it can't be written.
void write_truth(const std::filesystem::path& path, const World& world);

// Reads what write_truth wrote; keys that it does not know are ignored. Throws Error(input) where
// the file is missing or breaks the format.
World read_truth(const std::filesystem::path& path);

}  // namespace topple::scenes
