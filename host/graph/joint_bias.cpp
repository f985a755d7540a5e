// SPDX-License-Identifier: MIT
#include "graph/joint_bias.h"

#include <algorithm>

namespace topple::graph {

std::vector<Joint> biased_joints(std::span<const Joint> joints, std::int32_t primitives,
                                 double bias) {
    std::vector<std::int32_t> likely(static_cast<std::size_t>(primitives), 0);
    for (const Joint& j : joints) {
        if (j.log_odds <= 0) continue;
        ++likely[static_cast<std::size_t>(j.a)];
        ++likely[static_cast<std::size_t>(j.b)];
    }
    std::vector<Joint> out(joints.begin(), joints.end());
    for (Joint& j : out) {
        const std::int32_t witnesses =
            std::min(likely[static_cast<std::size_t>(j.a)], likely[static_cast<std::size_t>(j.b)]);
        j.log_odds += bias * (1 - 1.0 / std::max(1, witnesses));
    }
    return out;
}

}  // namespace topple::graph
