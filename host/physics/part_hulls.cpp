// SPDX-License-Identifier: MIT
#include "physics/part_hulls.h"

#include <utility>

#include "physics/merge_close_points.h"
#include "physics/qhull.h"
#include "solids/cell_shape.h"
#include "solids/solid_places.h"

namespace topple::physics {

PartHulls part_hulls(const SolidCells& cells, const BoundaryCells& boundary,
                     const std::vector<bool>& wanted, ThreadPool& threads) {
    SolidCells whole = cells;
    std::vector<std::vector<std::size_t>> parts(wanted.size());
    for (std::size_t b = 0; b < boundary.size(); ++b) {
        const auto p = static_cast<std::size_t>(boundary.primitive[b]);
        if (wanted[p]) parts[p].push_back(b);
    }
    solids::each_bounded_cell(cells, boundary, [&](std::size_t b, std::size_t n) {
        if (cells.primitive[n] == boundary.primitive[b]) whole.primitive[n] = -1;
    });
    for (std::int32_t& p : whole.primitive)
        if (p >= 0 && !wanted[p]) p = -1;
    const auto coarse = voxel_hulls(whole, static_cast<std::int32_t>(wanted.size()));
    PartHulls out{std::vector<std::vector<Vec3>>(wanted.size()),
                  solids::form_error_m(boundary, cells.voxel_m)};
    threads.each(wanted.size(), 1, [&](std::size_t p) {
        const double h = cells.voxel_m;
        std::vector<Vec3> points;
        for (const auto& c : coarse[p]) points.push_back({c[0] * h, c[1] * h, c[2] * h});
        for (const std::size_t b : parts[p]) solids::add_corners(boundary, b, h, points);
        constexpr double alike = 0.005;  // of a voxel
        points = merge_close_points(points, alike * h);
        if (const auto hull = convex_hull(points)) {
            for (const std::uint32_t v : hull->vertices) out.corners[p].push_back(points[v]);
        } else {
            out.corners[p] = std::move(points);
        }
    });
    return out;
}

}  // namespace topple::physics
