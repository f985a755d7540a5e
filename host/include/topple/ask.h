// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "topple/scene.h"

// Questions about what holds what in a finished parse, before things are taken away. Objects are
// told by their ids. The answers rest on Scene::supports, and on where the solid voxels
// (Scene::solid) of an object lie above those of what carries it; where a scene has no voxels, on
// the supports alone. Nothing here moves: what falls may hit, drag or block other things
// (Object::fall).
//
// All throw Error(usage) for an id that is none of the scene's, or that is grounded: the building,
// and what is fixed to it, is not taken away, and nothing has to hold it.
namespace topple {

// What falls once something is gone.
struct Unheld {
    std::int32_t object = -1;
    std::vector<std::int32_t> lost;  // what carried it and is taken, or falls before it; ascending
    std::vector<std::int32_t> left;  // what carried it and is still there; ascending
    // How far its centre of mass then lies outside of what is left, level, metres; NaN: nothing is
    // left, or only what it carries itself.
    double beyond_m = std::numeric_limits<double>::quiet_NaN();
    double probability = 0;  // that it falls: of the likeliest of the supports that it lost, times
                             // that this one goes
    std::string reason;      // in words
};

struct FallsWithout {
    std::vector<Unheld> falls;  // in the order in which they fall: those that rest on others later
    // What may fall, too: less likely than not; or it touches what goes, and the parse does not
    // know what holds it, or has it lean on what is beside it. Ascending.
    std::vector<std::int32_t> unsure;
};

// What falls if these objects are taken away, all at once, and nothing else is done.
//
// An object that loses a supporter falls, and is lost to what it carries,
//   - if no supporter is left, or those that are left are held up by it alone, in a ring;
//   - if its centre of mass then lies outside of the convex hull of what it stands on, by more than
//     half a voxel, and by half a voxel more than as it was scanned: what was scanned stood.
// It stands on a supporter where its voxels lie right above that one's; where they do nowhere, with
// gaps as noise leaves them. What is left and touches it from the side alone, as a wall does what
// hangs on it, holds it.
//
// Supports may be wrong (Support::probability): what rests on what falls by one falls as likely as
// both. Not reckoned with: how much what is left can bear, and friction.
FallsWithout falls_without(const Scene& scene, const std::vector<std::int32_t>& taken);

// An order in which everything but what is grounded can be taken away, so that nothing is taken
// before what it carries: what carries nothing first, of those the lowest id first. A step is one
// object, or a ring of objects that carry one another and have to go together, ascending.
std::vector<std::vector<std::int32_t>> removal_steps(const Scene& scene);

// The same of what has to go so that `before` can be taken away and nothing falls: what would fall
// without it, however likely; not what else is unsure (FallsWithout::unsure). The last step is
// `before`, with what is in a ring with it.
std::vector<std::vector<std::int32_t>> removal_steps(const Scene& scene, std::int32_t before);

// What carries an object.
struct Holder {
    std::int32_t object = -1;
    bool building = false;    // it is the building, or fixed to it
    double area_m2 = 0;       // on which it carries (Support::area_m2)
    double probability = 0;   // that it does
    bool from_below = false;  // voxels of the object lie above its own; else it touches its side,
                              // or the scene has no voxels
};

// What holds an object, the likeliest first, of equals the lower id. None: the parse has found
// nothing that does; Object::rests_by says how it is taken to stand.
std::vector<Holder> held_by(const Scene& scene, std::int32_t object);

}  // namespace topple
