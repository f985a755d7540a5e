// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "compare/side.h"
#include "topple/compare.h"

namespace topple::comparing {

// What became of the things of two results that lie on each other so.
std::vector<ComparedThing> match_things(const Side& a, const Side& b, const Mat4& a_from_b);

}  // namespace topple::comparing
