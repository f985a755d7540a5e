// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "objects/body_maker.h"

namespace topple {

// What objects would be if they were made of other primitives. Keeps references.
struct BodiesIf {
    device::Device& device;
    const physics::PartHulls& hulls;
    const SolidParts& parts;
    const BodyMaker& maker;
    const ObjectStage& stage;

    // The bodies that these sets of primitives would be, none of which share one, each with what a
    // push does to it. The rest of the building stands; what is in no set and not of the building
    // stands where it is, and is nobody's. What carries them stops them as it does the objects.
    // They weigh what their primitives weigh as they were read, and rub as the first of these does.
    std::vector<Body> operator()(std::vector<std::vector<std::int32_t>> primitives) const;
};

}  // namespace topple
