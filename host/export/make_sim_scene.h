// SPDX-License-Identifier: MIT
#pragma once

#include "export/sim_scene.h"

namespace topple {

struct SimSceneOptions {
    bool visuals = true;   // what bodies look like, beside what collides
    unsigned threads = 0;  // 0: as many as the machine has
};

// The scene of a parse as simulators see it. points: in `scene`, as far as their colours are known.
exports::SimScene make_sim_scene(const Scene& scene, const SolidScene& solids,
                                 const SimSceneOptions& options);

}  // namespace topple
