// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::oracle {

// Kernel normal_cluster: the axis with the largest |n . a| in double precision, and by how much it
// leads.
struct ClusterChoice {
    std::size_t cluster = 0;  // axes.size() where the normal is 0
    double lead = 0;
    double sign = 1;
};

inline ClusterChoice nearest_axis(const std::array<double, 3>& n,
                                  const std::vector<std::array<double, 3>>& axes) {
    ClusterChoice choice;
    choice.cluster = axes.size();
    double best = 0;
    for (std::size_t k = 0; k < axes.size(); ++k) {
        const double d = n[0] * axes[k][0] + n[1] * axes[k][1] + n[2] * axes[k][2];
        if (std::abs(d) > best) {
            choice = {k, std::abs(d) - best, d < 0 ? -1.0 : 1.0};
            best = std::abs(d);
        } else {
            choice.lead = std::min(choice.lead, best - std::abs(d));
        }
    }
    return choice;
}

}  // namespace topple::oracle
