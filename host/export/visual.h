// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/colour_space.h"
#include "core/object_surface.h"
#include "topple/scene.h"

namespace topple::exports {

struct SimScene;

// How a body looks: a closed surface in the body's frame, whose origin is its centre of mass and
// whose axes are the world's. Metres.
struct Visual {
    std::vector<Vec3> vertex, normal;
    std::vector<Rgb8> colour;                            // of each vertex
    std::vector<std::array<std::uint32_t, 3>> triangle;  // counter-clockwise seen from outside
};

// Gives the body of each object its surface, or its parts' where that encloses nothing, in the
// scan's colours; where these are not known, in the object's of io::colour_of(), the building in
// grey. surfaces: input frame.
void add_visuals(SimScene& sim, const Scene& scene, std::span<const ObjectSurface> surfaces);

}  // namespace topple::exports
