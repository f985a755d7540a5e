// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "export/sim_scene.h"

namespace topple {

struct SimSceneOptions {
    bool visuals = true;   // what bodies look like, beside what collides
    unsigned threads = 0;  // 0: as many as the machine has
};

// The scene of a parse as simulators see it. points: in `scene`, as far as their colours are known.
exports::SimScene make_sim_scene(const Scene& scene, const SolidScene& solids,
                                 const SimSceneOptions& options);

// The same of what a parse wrote into a folder: scene.json, solids.bin and, for the scan's colours,
// points.ply. Throws Error(input) that names the file that is missing or damaged.
exports::SimScene read_sim_scene(const std::filesystem::path& parsed,
                                 const SimSceneOptions& options);

}  // namespace topple
