// SPDX-License-Identifier: MIT
#pragma once

#include "topple/kernels/primitives/words.h"

// Running sums modulo 2^32, and what follows from them: Blelloch, "Prefix Sums and Their
// Applications" (1990): chunks are summed, the sums scanned, the chunks run through from there.
namespace topple::primitives {

// to[i] = sum of from before i; with `inclusive` up to i.
void scan(device::Queue& queue, Scratch& scratch, const Words& from, const Words& to,
          bool inclusive = false);

// The elements of `from` whose flag is not 0, in their order, to `to`; their number to count[0].
// What `to` has no room for is left out.
void compact(device::Queue& queue, Scratch& scratch, const Words& flags, const Words& from,
             const Words& to, const Words& count);

// Exclusive sums of one tile of chunks: offsets[i] = what carry held (0 at the first tile) + sum of
// sums before i; carry goes on by all of them. For primitives that go by chunks.
void scan_chunks(device::Queue& queue, Scratch& scratch, const Words& sums, const Words& offsets,
                 const Words& carry, bool first_tile);

}  // namespace topple::primitives
