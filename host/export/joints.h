// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "export/body.h"
#include "export/fronts.h"

namespace topple::exports {

// A door or a drawer as a body on a joint. Shut, as it was scanned. World frame.
struct JointedFront : Front {
    std::string name;        // object_ID_front_N
    std::size_t body = 0;    // what it is a part of: place in the scene's list
    std::vector<Box> boxes;  // they touch its body, and one another; simulators leave that out
    std::vector<ConvexPart> handle;  // of what was found as things where its handle is
    double mass_kg = 0;
    Vec3 center_m{};
    Mat3 inertia_kg_m2{};
    Vec3 axis{};      // unit; it opens along it, or around it by the right-hand rule
    Vec3 at_m{};      // a point of a hinge's axis, on the outer face
    double most = 0;  // metres or radians
    bool slides() const { return opening == Opening::slide; }

    // What holds it where it is while nobody pulls: newtons, or newton metres; and what slows it.
    double holding() const { return slides() ? 3 : 0.3; }
    double damping() const { return slides() ? 10 : 0.5; }
};

// The fronts of each object, of boards of the thickness and density of closed furniture's, where
// there is room for them, and their body can spare what they weigh: other bodies are cut back by
// little. What has no parts has no fronts. Before bodies are stood on feet, as what is cut may be
// what they stand on.
std::vector<JointedFront> place_fronts(std::vector<Body>& bodies,
                                       const std::vector<std::vector<Front>>& of_object,
                                       double density_kg_m3);

// Makes them bodies of their own, whose mass is taken from their body's. Those go that feet and
// pads were put into; then their handles are parts of what they are at.
void joint_fronts(std::vector<JointedFront>& fronts, std::vector<Body>& bodies);

}  // namespace topple::exports
