// SPDX-License-Identifier: MIT
#pragma once

#include "topple/kernels/primitives/words.h"

namespace topple::primitives {

// Keys of 32 bits, or of 64 in two words, and what belongs to them. A default Words is one that is
// not there.
struct Records {
    Words low;
    Words high{};
    Words value{};
};

// The records of `from` in ascending order of their keys to `to`, equal ones in the order in which
// they were: a radix sort by digits of 8 bits from the lowest on. `bits`: those of a key that may
// be set, from bit 0 on; 0 for all. It takes one pass over memory for each 8.
void sort(device::Queue& queue, Scratch& scratch, const Records& from, const Records& to,
          unsigned bits = 0);

}  // namespace topple::primitives
