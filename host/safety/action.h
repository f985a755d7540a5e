// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "topple/scene.h"

namespace topple::safety {

// Whether none of the disturbances upsets it as measured.
bool upset_by_nothing(const Object& object);

// Advice::action of one that is not fixed, of its category, risks and advice.
std::string action_text(const Scene& scene, const Object& object);

}  // namespace topple::safety
