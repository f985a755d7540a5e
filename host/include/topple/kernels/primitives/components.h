// SPDX-License-Identifier: MIT
#pragma once

#include "topple/kernels/primitives/words.h"

namespace topple::primitives {

// components[node]: the least node that edges from[i] - to[i] lead to from it. Edges of nodes that
// there are none of are left out. Nodes: as many as `components` has words; they must fit into one
// binding.
void connected_components(device::Queue& queue, Scratch& scratch, const Words& from,
                          const Words& to, const Words& components);

}  // namespace topple::primitives
