// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graph/joints.h"

namespace topple::graph {

// The joints around a primitive look at the same surfaces: they are no independent witnesses, and
// the sum of their log-odds says too much. Each joint gets bias * (1 - 1 / k), nats, k being how
// many likely joints (log-odds above 0) that one of its two primitives has that has fewer of them:
// a joint that is alone is believed as it is. Same order.
std::vector<Joint> biased_joints(std::span<const Joint> joints, std::int32_t primitives,
                                 double bias);

}  // namespace topple::graph
