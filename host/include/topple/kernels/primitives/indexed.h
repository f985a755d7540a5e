// SPDX-License-Identifier: MIT
#pragma once

#include "topple/kernels/primitives/words.h"

namespace topple::primitives {

// to[i] = from[index[i]]; where the index lies outside of `from`, to[i] is left as it is.
void gather(device::Queue& queue, const Words& index, const Words& from, const Words& to);

// to[index[i]] = from[i]; no index may stand twice, and those outside of `to` are left out.
void scatter(device::Queue& queue, const Words& index, const Words& from, const Words& to);

// sums[key[i]] += value[i], modulo 2^32; keys outside of `sums` are left out.
void add_by_key(device::Queue& queue, const Words& keys, const Words& values, const Words& sums);

// counts[key[i]] += 1; keys outside of `counts` are left out.
void histogram(device::Queue& queue, const Words& keys, const Words& counts);

}  // namespace topple::primitives
