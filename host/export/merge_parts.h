// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "export/convex_part.h"

namespace topple::exports {

// Joins parts of one body two by two, cheapest first, while the hull of both is hardly larger than
// they are: by `most_m3` in all, and no two by more than a tenth.
void merge_parts(std::vector<ConvexPart>& parts, double most_m3, double touching_m);

}  // namespace topple::exports
