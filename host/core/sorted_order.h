// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/thread_pool.h"

namespace topple {

// The order that sorts keys ascending; equal keys keep their order. Radix sort over the bits in
// use. Fewer than 2^32 keys.
std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> keys, ThreadPool& threads);
std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> keys);

}  // namespace topple
