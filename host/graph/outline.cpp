// SPDX-License-Identifier: MIT
#include "graph/outline.h"

#include <algorithm>
#include <utility>

#include "physics/tipping.h"

namespace topple::graph {

Outline outline_of(std::vector<BorderPoint> points) {
    // Of several at one place the best known one.
    const auto at = [](const BorderPoint& p) { return std::pair(p.at, p.error_m); };
    std::ranges::sort(points, {}, at);
    const auto same = [](const BorderPoint& a, const BorderPoint& b) { return a.at == b.at; };
    points.erase(std::unique(points.begin(), points.end(), same), points.end());
    std::vector<std::array<double, 2>> places;
    places.reserve(points.size());
    for (const BorderPoint& p : points) places.push_back(p.at);
    Outline out;
    out.polygon = physics::convex_polygon(std::move(places));
    for (const auto& corner : out.polygon) {
        const auto found = std::ranges::lower_bound(points, corner, {}, &BorderPoint::at);
        out.error_m += found->error_m / static_cast<double>(out.polygon.size());
    }
    return out;
}

void add_points(const std::vector<std::array<double, 2>>& polygon, double error_m,
                std::vector<BorderPoint>& points) {
    for (const auto& at : polygon) points.push_back({at, error_m});
}

}  // namespace topple::graph
