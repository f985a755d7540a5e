// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/object_of.h"
#include "objects/object_stage.h"

namespace topple {

// By object, what it may be a leg of, and -1 for none: a slim upright thing that stands below
// something of which nobody saw what holds it up, and reaches most of the way to its underside,
// with nothing between. The upper end of a leg is in the shade of what it carries.
std::vector<std::int32_t> find_legs(const SolidScene& solids, ObjectOf object_of,
                                    TableView<ObjectId, Body> objects);

}  // namespace topple
