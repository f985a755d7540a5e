// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::parses {

inline constexpr int calls_of_a_seed = 40;

// So many calls of topple/topple.h by chance, all of its functions, some from two threads at once:
// in any order, with structs of any size, indices that are not there, NULL where a pointer may be,
// counts that no memory holds, numbers that are not finite and small clouds and frames; handles
// that live. Every call returns a code that it may, a message of one line where it fails, and
// writes nothing beyond a struct's own size. What does not hold is returned in words.
std::string try_calls(std::uint64_t seed);

}  // namespace topple::parses
