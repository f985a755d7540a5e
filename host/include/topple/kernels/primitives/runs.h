// SPDX-License-Identifier: MIT
#pragma once

#include "topple/kernels/primitives/words.h"

namespace topple::primitives {

// Runs of neighbouring elements: of equal keys in a sorted list, of 32 bits or of 64 in two words,
// or segments that each flag other than 0 opens. The first element always begins one.
struct Segments {
    static Segments of_flags(const Words& flags) { return {flags, flags, 0}; }
    static Segments of_keys(const Words& keys) { return {keys, keys, 2}; }
    static Segments of_keys(const Words& low, const Words& high) { return {low, high, 3}; }

    Words low, high;
    std::uint32_t kind;  // RUN_OF_... of kernels/primitives/functions.h
};

// Of each run its key and where it begins; count[0]: the number of runs. Outputs hold as many words
// as there may be runs; `starts` one more, for the number of elements behind the last run's start.
// What they have no room for is left out. high_to is used for 64-bit keys only.
void unique(device::Queue& queue, Scratch& scratch, const Segments& runs, const Words& low_to,
            const Words& high_to, const Words& starts, const Words& count);

// lengths[i] = starts[i + 1] - starts[i] of the count[0] runs.
void run_lengths(device::Queue& queue, const Words& starts, const Words& count,
                 const Words& lengths);

// The sum of each run's values, modulo 2^32, and count[0]: the number of runs.
void segmented_sum(device::Queue& queue, Scratch& scratch, const Segments& runs,
                   const Words& values, const Words& sums, const Words& count);

// Running sums modulo 2^32 that begin anew with each run; with `inclusive` an element's own is in
// it.
void segmented_scan(device::Queue& queue, Scratch& scratch, const Segments& runs,
                    const Words& values, const Words& to, bool inclusive = true);

}  // namespace topple::primitives
