// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "lab/random.h"
#include "lab/solids/ray_caster.h"
#include "lab/solids/scene.h"

// Where a person holds a camera, or puts a scanner up, in a room full of things. Room frame.
namespace topple::scenes {

// Stations `height` above the floor, far from one another, each clear of all solids.
std::vector<Vec3> scanner_stations(const World& world, const RayCaster& caster, unsigned count,
                                   double height, Random& random);

// A hand-held walk along free ways, from one place to the next, looking at things beside it; with
// the sway of a hand. Camera to room.
std::vector<Mat4> hand_held_walk(const World& world, const RayCaster& caster, unsigned frames,
                                 Random& random);

// The one of some views at random from which most things are seen.
Mat4 best_view(const World& world, const RayCaster& caster, Random& random);

}  // namespace topple::scenes
