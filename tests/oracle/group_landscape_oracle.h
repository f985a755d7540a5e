// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::oracle {

// One member of a group: its tabulated support function at one direction, and where its origin lies
// from the centre of mass.
struct LandscapeMember {
    float s = 0;
    std::array<float, 3> offset{};
};

// U / (M g) = -min over members of (s + offset . d), in double precision, and the bound of a float
// sum of four terms: 4 roundings of at most the sum of their sizes.
inline void group_height(const std::vector<LandscapeMember>& members, const std::array<float, 3>& d,
                         double& height, double& bound) {
    double low = std::numeric_limits<double>::infinity();
    bound = 0;
    for (const LandscapeMember& m : members) {
        double value = m.s, size = std::abs(double{m.s});
        for (std::size_t a = 0; a < 3; ++a) {
            value += double{m.offset[a]} * d[a];
            size += std::abs(double{m.offset[a]} * d[a]);
        }
        low = std::min(low, value);
        bound = std::max(bound, 4.001 * 0x1p-24 * size);
    }
    height = -low;
}

}  // namespace topple::oracle
