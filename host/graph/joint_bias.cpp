// SPDX-License-Identifier: MIT
#include "graph/joint_bias.h"

#include <algorithm>

namespace topple::graph {

std::vector<Joint> biased_joints(std::span<const Joint> joints,
                                 const Table<PrimitiveId, bool>& pinned, double bias) {
    const auto free = [&](PrimitiveId p) { return !pinned[p]; };
    const auto things = static_cast<double>(std::ranges::count(pinned, false));
    const auto between = static_cast<double>(
        std::ranges::count_if(joints, [&](const Joint& j) { return free(j.a) && free(j.b); }));
    const double crowded = things > 0 ? std::max(1.0, 2 * between / things / most_neighbours) : 1;
    std::vector<Joint> out(joints.begin(), joints.end());
    for (Joint& j : out) j.log_odds += bias * crowded * crowded * crowded;
    return out;
}

}  // namespace topple::graph
