// SPDX-License-Identifier: MIT
#include "graph/outline.h"

#include <algorithm>
#include <map>

#include "physics/tipping.h"

namespace topple::graph {

Outline outline_of(const std::vector<BorderPoint>& points) {
    std::map<std::array<double, 2>, double> error;
    std::vector<std::array<double, 2>> places;
    for (const BorderPoint& p : points) {
        const auto [at, added] = error.emplace(p.at, p.error_m);
        if (!added) at->second = std::min(at->second, p.error_m);
        if (added) places.push_back(p.at);
    }
    Outline out;
    out.polygon = physics::convex_polygon(std::move(places));
    for (const auto& corner : out.polygon)
        out.error_m += error[corner] / static_cast<double>(out.polygon.size());
    return out;
}

void add_points(const std::vector<std::array<double, 2>>& polygon, double error_m,
                std::vector<BorderPoint>& points) {
    for (const auto& at : polygon) points.push_back({at, error_m});
}

}  // namespace topple::graph
