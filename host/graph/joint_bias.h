// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "core/table.h"
#include "graph/joints.h"

namespace topple::graph {

// Surfaces that each meet those around them have fewer neighbours than this, in the mean (Euler's
// formula for planar graphs); in scans of rooms and tables they have one to five. Where noise
// breaks surfaces into fragments, joints reach past the nearest, to seven or eight of them, and say
// the same thing several times.
inline constexpr double most_neighbours = 6;

// The joints around a primitive look at the same surfaces: they are no independent witnesses, and
// the sum of their log-odds says too much. Each gets bias * max(1, k / most_neighbours)^3, nats, k
// being the mean number of neighbours of what is not pinned to the room. All get the same, those
// that are alone as well: what touches another thing once is no likelier to be a part of it. Same
// order.
std::vector<Joint> biased_joints(std::span<const Joint> joints,
                                 const Table<PrimitiveId, bool>& pinned, double bias);

}  // namespace topple::graph
