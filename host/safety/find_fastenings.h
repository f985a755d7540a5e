// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "objects/object_stage.h"
#include "solids/solid_parts.h"

namespace topple {

// What an object may be fastened to.
struct Fastening {
    bool wall = true;    // something of the building is within reach of its top
    bool floor = false;  // it stands on the floor, and not on a thing
};

// By object. Brackets and straps at its top reach 0.3 m to a wall, be it seen or behind what hides
// it, or to what is fixed to one.
std::vector<Fastening> find_fastenings(const SolidParts& parts, const ObjectStage& objects);

}  // namespace topple
