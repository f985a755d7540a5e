// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "core/solid_scene.h"

namespace topple {

// A scene of solids in its parts, as a file holds it. A file says anything, so this is no scene
// yet.
struct SavedSolids {
    SolidCells cells, strays;
    BoundaryCells boundary;
    std::vector<Role> roles;
};

SavedSolids saved(const SolidScene& solids);

// The only way from a file to a scene. Throws Error(input), which says why, where no parse makes
// such a one: beyond what any SolidScene must be, its voxels have a size and lie together.
std::shared_ptr<const SolidScene> scene_of(SavedSolids saved);

}  // namespace topple
