// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "objects/bodies_if.h"

// The other reading of objects that may be a piece of a larger one, or two in one.
namespace topple {

// Of each object that its joints doubt: as one thing with the larger object that it may be a piece
// of, and as the two that it may be. Only that one object is another then. By object, the likelier
// reading first.
std::vector<OtherReading> find_alternatives(const BodiesIf& bodies_if,
                                            std::span<const graph::Joint> joints,
                                            const graph::KnownLinks& links);

}  // namespace topple
