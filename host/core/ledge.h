// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace topple {

// A height at which one primitive is known to stand on another, where neither shows it: of a ledge
// in a stack.
struct Ledge {
    std::int32_t above = -1, below = -1;  // primitives
    double height_m = 0;                  // along up, from the origin
};

}  // namespace topple
