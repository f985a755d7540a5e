// SPDX-License-Identifier: MIT
#pragma once

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

// Makes the fronts of each object bodies of their own, whose mass is taken from its body's. Boards
// of the thickness and of a density of closed furniture's, which lie in no other body. What has no
// parts has no fronts.
std::vector<JointedFront> jointed_fronts(std::vector<Body>& bodies,
                                         const std::vector<std::vector<Front>>& of_object,
                                         double density_kg_m3);

}  // namespace topple::exports
