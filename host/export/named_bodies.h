// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "export/shape.h"
#include "export/sim_scene.h"

namespace topple::exports {

// What a body is called in every format; place: in the scene's list of bodies.
std::string body_name(const Body& body, std::size_t place);

struct NamedPart {
    std::string name;  // object_ID_part_N
    const ConvexPart* part = nullptr;
    Shape shape;  // in the body's frame: from its centre of mass
};

// Of a front: object_ID_front_M, with its boxes in its own frame, from its centre of mass.
struct NamedFront {
    const JointedFront* front = nullptr;
    std::vector<Box> boxes;
    std::string joint() const { return front->name + "_joint"; }
};

struct NamedBody {
    std::string name;  // object_ID, or pad_N
    const Body* body = nullptr;
    double friction = 0;  // coefficient
    std::vector<NamedPart> parts;
    std::vector<NamedFront> fronts;
};

// Whether a simulator may take its mass; and its inertia, too.
bool has_mass(const Body& body);
bool has_inertia(const Body& body);

// The bodies that have a shape, as every format names them. Throws Error(input) that names the one
// that no simulator takes: mass and inertia must be positive, and all numbers finite.
std::vector<NamedBody> named_bodies(const SimScene& scene);

}  // namespace topple::exports
