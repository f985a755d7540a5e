// SPDX-License-Identifier: MIT
#pragma once

#include "topple/scene.h"

namespace topple::cli {

// By which one acts: the category, within one above none first what is certain to be in it, and
// then the unsafety, which is above 0 and 10 at most. What has no rank comes last.
inline double urgency_of(const Object& o) {
    const int category = o.unsafety_category == "high"     ? 3
                         : o.unsafety_category == "medium" ? 2
                         : o.unsafety_category == "low"    ? 1
                                                           : 0;
    return 10 * (2 * category + (category > 0 && o.unsafety_certain)) + rank_of(o);
}

}  // namespace topple::cli
