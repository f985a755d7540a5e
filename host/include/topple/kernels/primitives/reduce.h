// SPDX-License-Identifier: MIT
#pragma once

#include "topple/kernels/primitives/words.h"

namespace topple::primitives {

enum class Reduction : std::uint32_t { sum, least, greatest };

// All of `from` to to[0]: unsigned integers modulo 2^32; of none 0, 2^32 - 1 and 0.
void reduce(device::Queue& queue, Scratch& scratch, Reduction reduction, const Words& from,
            const Words& to);

// Floats, none NaN: sums in one order on all devices, 16 strands of 64 for each 1,024 and so on
// with their sums; of none 0, infinity and -infinity.
void reduce(device::Queue& queue, Scratch& scratch, Reduction reduction,
            const device::Slice<float>& from, const device::Slice<float>& to);

}  // namespace topple::primitives
