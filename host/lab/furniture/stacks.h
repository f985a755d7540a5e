// SPDX-License-Identifier: MIT
#pragma once

#include "lab/furniture/things.h"

namespace topple::scenes {

inline double stack_height(const Stack& stack) {
    double high = 0;
    for (const Blueprint& b : stack) high += b.height();
    return high;
}

// The first of a dozen that any() makes which is lower than `clearance`; empty where none is.
template <class Any>
Stack any_that_fits(double clearance, const Any& any) {
    for (int attempt = 0; attempt < 12; ++attempt) {
        Stack stack = any();
        if (!stack.empty() && stack_height(stack) < clearance) return stack;
    }
    return {};
}

}  // namespace topple::scenes
