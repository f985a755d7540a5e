// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "objects/object_stage.h"

namespace topple {

// Of each object what goes along with it, ascending: what has lost half of its support with it, and
// with what went along before. Not of the ground.
std::vector<std::vector<std::int32_t>> taken_along(const ObjectStage& objects);

}  // namespace topple
