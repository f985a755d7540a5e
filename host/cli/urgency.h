// SPDX-License-Identifier: MIT
#pragma once

#include "topple/scene.h"

namespace topple::cli {

// By which one acts: the category, and within one the unsafety, which is above 0 and 10 at most.
// What was not seen enough comes last.
inline double urgency_of(const Object& o) {
    if (!o.seen_enough) return 0;
    const int category = o.unsafety_category == "high"     ? 3
                         : o.unsafety_category == "medium" ? 2
                         : o.unsafety_category == "low"    ? 1
                                                           : 0;
    return 10 * category + o.unsafety;
}

}  // namespace topple::cli
