// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "safety/human/walkable_map.h"

// Straight lines over the cells of the walkable map, as walkers follow them.
namespace topple::safety {

// Calls visit(cell) for the cells of the straight line from a to b, both included, until it returns
// false; says whether it never did.
template <class Visit>
bool along_line(const WalkableMap& map, Place a, Place b, Visit visit) {
    const std::int64_t dx = b.x - a.x, dy = b.y - a.y;
    const std::int64_t n = std::max(std::abs(dx), std::abs(dy));
    const auto rounded = [n](std::int64_t v) {  // v / n to the nearest, halves away from 0
        return (2 * std::abs(v) + n) / (2 * n) * (v < 0 ? -1 : 1);
    };
    for (std::int64_t s = 0; s <= n; ++s) {
        const std::int64_t x = a.x + (n ? rounded(dx * s) : 0), y = a.y + (n ? rounded(dy * s) : 0);
        if (!visit(map.index({x, y}))) return false;
    }
    return true;
}

}  // namespace topple::safety
