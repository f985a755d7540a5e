// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "objects/object_stage.h"
#include "result/explanations.h"
#include "safety/safety_stage.h"

namespace topple {

// What of the building may be a thing, by risk times probability.
std::vector<PossibleThing> possible_things(const SolidCells& cells, const ObjectStage& objects,
                                           const SafetyStage& safety, const ToInput& to_input);

// Those that would be of medium or high category, in a sentence with their sizes and places and
// what to do if they are things; "" where there are none.
std::string possible_things_note(std::span<const PossibleThing> things);

}  // namespace topple
