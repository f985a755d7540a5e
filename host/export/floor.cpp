// SPDX-License-Identifier: MIT
#include "export/floor.h"

#include <utility>

namespace topple::exports {

void widen_floor(ConvexPart& floor, const std::vector<Body>& bodies, double voxel_m) {
    constexpr double near_m = 0.3;
    const double top = floor.high[2];
    std::vector<Vec3> points = floor.corner;
    for (const Body& body : bodies) {
        for (const ConvexPart& part : body.parts) {
            if (part.low[2] < top - 2 * voxel_m || part.low[2] > top + near_m) continue;
            for (const Vec3& c : part.corner) {
                points.push_back({c[0], c[1], top});
                points.push_back({c[0], c[1], floor.low[2]});
            }
        }
    }
    if (auto wide = reshaped(floor, points)) floor = *std::move(wide);
}

}  // namespace topple::exports
