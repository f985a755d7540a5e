// SPDX-License-Identifier: MIT
#pragma once

#include "scan_base.hpp"
#include "topple/kernels/primitives/words.h"

namespace topple::primitives {

// Chunks that the work-items of a kernel take, of ITEMS elements each. ITEMS is 2 or more: levels
// of chunks of chunks are added until few are left, which with 1 would never be.
template <class Kernel>
std::uint64_t chunks_of(const device::Device& device, std::uint64_t count) {
    const std::uint64_t items = device.items_per_lane(Kernel::source());
    return (count + items - 1) / items;
}

// 0 to one word, in the order of the queue.
inline void clear(device::Queue& queue, Scratch& scratch, const Words& word) {
    const auto none = scratch.take(1), nothing = scratch.take(1);
    queue.add<kernels::ScanBase>(1, {.src = none, .dst = nothing, .carry = part(word, 0, 1)},
                                 {.count = 0, .mode = 1});
}

}  // namespace topple::primitives
