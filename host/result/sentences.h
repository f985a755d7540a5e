// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "objects/object_stage.h"
#include "safety/advise.h"
#include "safety/landing.h"
#include "solids/solid_parts.h"
#include "topple/scene.h"

namespace topple {

// Why each object is as safe as it is, in plain words, from its `why` and `fall`. landings: by
// object, or none, where nothing stops a fall.
void write_reasons(const SolidParts& parts, const ObjectStage& objects,
                   std::span<const Landing> landings, Scene& scene);

// What is advised for each object, and what to do about it, in plain words, from what was
// suggested, by object.
void write_advice(std::span<const Suggestion> suggestions, Scene& scene);

}  // namespace topple
