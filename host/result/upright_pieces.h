// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "objects/object_stage.h"
#include "result/explanations.h"
#include "solids/solid_parts.h"

namespace topple {

// Upright pieces of the building that stand on a floor, are as large as furniture and not surely
// the room's, in a sentence with their sizes and places and what to do if they are things; "" where
// there are none.
std::string upright_pieces_note(const SolidParts& parts, const ObjectStage& objects,
                                const ToInput& to_input);

}  // namespace topple
