// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "compare/side.h"
#include "topple/compare.h"

namespace topple::comparing {

// Lays one result on another, both in their grid frames, whose axes are those of walls: so but for
// small turns there are four ways to turn it and a shift, found by where walls, floors and ceilings
// lie, and then refined on all of the building's surfaces. Of several ways that fit about as well
// the one counts in which both have the same coordinates in their inputs' frames.
// poll: called now and then. Throws Error(input) where they fit in no way, or in several.
Alignment align(const Side& a, const Side& b, const std::function<void()>& poll);

}  // namespace topple::comparing
