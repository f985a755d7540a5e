// SPDX-License-Identifier: MIT
#pragma once

#include "lab/solids/part.h"

namespace topple::scenes {

// Whether the boxes around two parts meet, so that the parts may.
inline bool boxes_meet(const Part& a, const Part& b) {
    const auto p = a.bounds(), q = b.bounds();
    bool meet = true;
    for (std::size_t k = 0; k < 3; ++k)
        meet = meet && p[0][k] < q[1][k] - 1e-9 && q[0][k] < p[1][k] - 1e-9;
    return meet;
}

}  // namespace topple::scenes
