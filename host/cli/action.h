// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "topple/scene.h"

namespace topple::cli {

// Whether none of the disturbances upsets it as measured.
bool upset_by_nothing(const Object& o);

// What to do about one that is not fixed, as the report's cards say it; "" where it is not known.
std::string action_text(const Scene& scene, const Object& o);

}  // namespace topple::cli
