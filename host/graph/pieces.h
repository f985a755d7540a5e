// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graph/joints.h"
#include "graph/known_links.h"

namespace topple::graph {

// Of an object the likeliest joint to a larger one that grouping left apart from it: the
// probability that it is no whole but a piece, half of a desk, say, or a shelf of a cupboard. A
// smaller one would change little of what is said of it.
struct PieceOf {
    double probability = 0;
    std::int32_t primitive = -1;  // the other's
};

// By object. surface: voxels of each in which its surface was seen; those of none are nobody's
// whole, as the ground, which is no thing. What is known to be one object or none is no question.
std::vector<PieceOf> likely_pieces(std::span<const Joint> joints, const KnownLinks& links,
                                   std::span<const std::int32_t> object_of_primitive,
                                   std::span<const std::uint64_t> surface);

}  // namespace topple::graph
