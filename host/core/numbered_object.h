// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "topple/scene.h"

namespace topple {

// "object 3", or "object 3 (fridge)".
inline std::string numbered_object(const Object& o) {
    const std::string text = "object " + std::to_string(o.id);
    return o.name.empty() ? text : text + " (" + o.name + ")";
}

}  // namespace topple
