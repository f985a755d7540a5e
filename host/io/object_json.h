// SPDX-License-Identifier: MIT
#pragma once

#include "core/json.h"
#include "topple/scene.h"

// One object of scene.json, with all that is known of how it stands and what it risks.
namespace topple::io {

OrderedJson json_of_object(const Object& object);
// What earlier versions did not write stays as a new object has it. Throws nlohmann's exceptions
// for what is none.
Object object_of(const OrderedJson& json);

}  // namespace topple::io
