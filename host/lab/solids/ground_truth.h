// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "lab/solids/scene.h"

namespace topple::scenes {

// The truth about a scene as JSON: seed, tilt (3x3), room, parts (id, kind, center, size, yaw,
// top_ratio, object, name, volume; lean, rounding, profile where there are such), objects (id,
// name, where), fixed and support as pairs of part ids. Kinds: box, rounded, cyl, lying, sph, cone,
// revolved. Throws Error(input) where it can't be written.
void write_truth(const std::filesystem::path& path, const World& world);

// The parts as they stand there, and one but for its ids.
nlohmann::json parts_json(const World& world);
nlohmann::json part_json(const Part& part);

}  // namespace topple::scenes
