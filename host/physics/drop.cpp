// SPDX-License-Identifier: MIT
#include "physics/drop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/tipping.h"

namespace topple::physics {

namespace {

// Over an edge, or a border, that is `distance` from the centre of mass.
double drop_over(const SolidCells& cells, const CellColumns& columns, const Candidate& body,
                 const Vec3& direction, double distance) {
    const double h = cells.voxel_m;
    // Over its edge the centre of mass lands about its own height away; where the body leans on
    // something nearer or farther it stops there.
    const double height = std::max(body.body.center[2] - body.support_height_m, 2 * h);
    double highest = -std::numeric_limits<double>::infinity();
    for (const double along : {0.5, 1.0, 1.5}) {
        const double reach = std::max(distance, 0.0) + along * height;
        const auto i =
            static_cast<std::int32_t>(std::floor((body.body.center[0] + reach * direction[0]) / h));
        const auto j =
            static_cast<std::int32_t>(std::floor((body.body.center[1] + reach * direction[1]) / h));
        const auto [first, last] = columns.at(i, j);
        for (std::size_t c = first; c < last; ++c) {
            const double top = (cells.k[c] + 1) * h;
            if (top > body.body.center[2]) break;  // above where it is: no place to land
            if (!std::binary_search(body.primitives.begin(), body.primitives.end(),
                                    cells.primitive[c]))
                highest = std::max(highest, top);
        }
    }
    if (!std::isfinite(highest)) return 0;
    const double drop = body.support_height_m - highest;
    return drop > 1.5 * h ? drop : 0;  // a voxel is noise
}

}  // namespace

std::vector<double> drops_when_tipped_m(const SolidCells& cells, const CellColumns& columns,
                                        const Candidate& body) {
    const Footing foot = footing(body.support_polygon, body.body.center[0], body.body.center[1]);
    if (foot.edges.empty()) return {drop_over(cells, columns, body, foot.away, 0)};
    std::vector<double> drops;
    for (const Footing::Edge& edge : foot.edges)
        drops.push_back(drop_over(cells, columns, body, edge.outward, edge.distance_m));
    return drops;
}

double drop_when_tipped_m(const SolidCells& cells, const CellColumns& columns,
                          const Candidate& body) {
    const Footing foot = footing(body.support_polygon, body.body.center[0], body.body.center[1]);
    const auto weakest = std::ranges::min_element(foot.edges, {}, &Footing::Edge::distance_m);
    const Vec3 direction = foot.edges.empty() ? foot.away : weakest->outward;
    return drop_over(cells, columns, body, direction, foot.margin_m);
}

}  // namespace topple::physics
