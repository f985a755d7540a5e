// SPDX-License-Identifier: MIT
#include "physics/fall_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace topple::physics {
namespace {

// At most so many points of a front, and angles: of things taller than 10 m, by voxels of a
// centimetre, what stops them by a twentieth of their height is found all the same.
constexpr double most_points = 2000, most_steps = 4000;

// The primitive of another body at a point, or nothing.
std::optional<std::int32_t> other_at(const SolidCells& cells, const CellColumns& columns,
                                     const Candidate& body, std::span<const std::int32_t> along,
                                     const Vec3& at) {
    const double h = cells.voxel_m;
    const auto index = [h](double x) { return static_cast<std::int32_t>(std::floor(x / h)); };
    const auto [first, last] = columns.at(index(at[0]), index(at[1]));
    const auto begin = cells.k.begin();
    const auto from = begin + static_cast<std::ptrdiff_t>(first),
               to = begin + static_cast<std::ptrdiff_t>(last);
    const auto found = std::lower_bound(from, to, index(at[2]));
    if (found == to || *found != index(at[2])) return std::nullopt;
    const std::int32_t primitive = cells.primitive[found - begin];
    if (std::ranges::binary_search(body.primitives, primitive) ||
        std::ranges::binary_search(along, primitive))
        return std::nullopt;
    return primitive;
}

}  // namespace

Swept sweep_over_edge(const SolidCells& cells, const CellColumns& columns, const HiddenWalls& walls,
                      const Candidate& body, std::span<const std::int32_t> along, double support_m,
                      const Vec3& direction, double beside_m, double top_m,
                      const std::vector<bool>& stops) {
    const Vec3& c = body.body.center;
    const double voxel = cells.voxel_m;
    const double height = std::max(c[2] - support_m, 0.0), beside = std::max(beside_m, 0.0);
    const double top = std::max(top_m - support_m, height);
    // Turned by an angle, from the edge: a point ahead and above as the body stands.
    const auto turned = [&](double angle, double ahead, double above) -> Vec3 {
        const double u = ahead * std::cos(angle) + above * std::sin(angle);
        return {c[0] + (beside + u) * direction[0], c[1] + (beside + u) * direction[1],
                support_m + above * std::cos(angle) - ahead * std::sin(angle)};
    };
    // Points of the front, so close that no voxel is missed between them or between two angles. A
    // single voxel, or what is low, is no stop.
    const auto points =
        static_cast<int>(std::min(std::ceil((top - height) / (voxel / 2)), most_points)) + 1;
    const int enough = std::min(points, std::max(2, points / 20));
    const int steps =
        2 + static_cast<int>(std::min(std::ceil(top * std::numbers::pi / voxel), most_steps));
    for (int step = 1; step <= steps; ++step) {
        const double angle = std::numbers::pi / 2 * step / steps;
        int met = 0;
        for (int n = 0; n < points; ++n) {
            const double above = points > 1 ? height + (top - height) * n / (points - 1) : height;
            const Vec3 at = turned(angle, 0, above);
            if (at[2] < support_m + 2 * voxel) continue;
            auto by = other_at(cells, columns, body, along, at);
            const bool gives_way = by && !stops.empty() && (*by < 0 || !stops[*by]);
            if (!by || gives_way) by = walls.between(c, at);
            if (by && ++met == enough) return {turned(angle, -beside, height), true, *by};
        }
    }
    return {turned(std::numbers::pi / 2, -std::min(beside, height), height)};
}

}  // namespace topple::physics
