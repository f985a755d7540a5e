// SPDX-License-Identifier: MIT
#include "physics/drop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/tipping.h"

namespace topple::physics {
namespace {

struct Landing {
    double drop_m = 0;
    std::int32_t onto = -1;  // primitive
};

// Whether its support may go on unseen where it ends on the way out, from `from` to `to`.
bool ends_unseen(const SolidCells& cells, const CellColumns& columns, const Candidate& body,
                 const Vec3& direction, double from, double to, const Unseen& unseen) {
    if (!unseen) return false;
    const double h = cells.voxel_m;
    const auto support = static_cast<std::int32_t>(std::lround(body.support_height_m / h)) - 1;
    for (double reach = from; reach < to; reach += h / 2) {
        const auto i =
            static_cast<std::int32_t>(std::floor((body.body.center[0] + reach * direction[0]) / h));
        const auto j =
            static_cast<std::int32_t>(std::floor((body.body.center[1] + reach * direction[1]) / h));
        if (may_carry(unseen, i, j, support)) return true;
        const auto [first, last] = columns.at(i, j);
        bool holds = false;
        for (std::size_t c = first; c < last; ++c)
            holds = holds || std::abs(cells.k[c] - support) <= 1;
        if (!holds) return false;
    }
    return false;
}

// Over an edge, or a border, that is `distance` from the centre of mass.
Landing landing(const SolidCells& cells, const CellColumns& columns, const Candidate& body,
                const Vec3& direction, double distance, const Unseen& unseen = {}) {
    const double h = cells.voxel_m;
    std::int32_t onto = -1;
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
            if (top <= highest || std::binary_search(body.primitives.begin(), body.primitives.end(),
                                                     cells.primitive[c]))
                continue;
            highest = top;
            onto = cells.primitive[c];
        }
    }
    const double drop = body.support_height_m - highest;
    if (!std::isfinite(highest) || drop <= 1.5 * h) return {};  // a voxel is noise
    const double edge = std::max(distance, 0.0);
    if (ends_unseen(cells, columns, body, direction, edge, edge + 1.5 * height, unseen)) return {};
    return {drop, onto};
}

}  // namespace

std::vector<double> drops_when_tipped_m(const SolidCells& cells, const CellColumns& columns,
                                        const Candidate& body, const Unseen& unseen) {
    const Footing foot = footing(body.support_polygon, body.body.center[0], body.body.center[1]);
    if (foot.edges.empty()) return {landing(cells, columns, body, foot.away, 0, unseen).drop_m};
    std::vector<double> drops;
    for (const Footing::Edge& edge : foot.edges)
        drops.push_back(
            landing(cells, columns, body, edge.outward, edge.distance_m, unseen).drop_m);
    return drops;
}

std::int32_t met_when_tipped(const SolidCells& cells, const CellColumns& columns,
                             const Candidate& body, const Vec3& direction, const Vec3& on_edge) {
    const Vec3& c = body.body.center;
    // Outside of its footing it falls from where it is.
    const bool inside = footing(body.support_polygon, c[0], c[1]).margin_m > 0;
    const double distance = (on_edge[0] - c[0]) * direction[0] + (on_edge[1] - c[1]) * direction[1];
    return landing(cells, columns, body, direction, inside ? distance : 0).onto;
}

}  // namespace topple::physics
