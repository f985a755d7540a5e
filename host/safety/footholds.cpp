// SPDX-License-Identifier: MIT
#include "safety/footholds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "core/scan_gaps.h"
#include "core/vectors.h"
#include "physics/tipping.h"

namespace topple::safety {
namespace {

// A voxel in its column, counted from the lowest one.
struct ColumnCell {
    std::int32_t i, j, k, object;
};

// The voxels of a scene, by column, from below.
struct VoxelColumns {
    std::vector<ColumnCell> cells;
    Vec3 lowest{};  // centre of voxel (0, 0, 0), along the room's axes

    VoxelColumns(const Scene& scene, const Rotation& axes) {
        const SolidVoxels& solid = scene.solid;
        const auto place = [&](std::size_t n) {
            return turned(axes, {solid.x[n], solid.y[n], solid.z[n]});
        };
        lowest.fill(std::numeric_limits<double>::infinity());
        for (std::size_t n = 0; n < solid.x.size(); ++n) {
            const Vec3 at = place(n);
            for (std::size_t a = 0; a < 3; ++a) lowest[a] = std::min(lowest[a], at[a]);
        }
        cells.reserve(solid.x.size());
        for (std::size_t n = 0; n < solid.x.size(); ++n) {
            const Vec3 at = place(n);
            const auto index = [&](std::size_t a) {
                return static_cast<std::int32_t>(
                    std::lround((at[a] - lowest[a]) / scene.voxel_size_m));
            };
            cells.push_back({index(0), index(1), index(2), solid.object[n]});
        }
        std::ranges::sort(cells, {}, [](const ColumnCell& c) { return std::tie(c.i, c.j, c.k); });
    }
};

// The columns of one support.
struct FootColumns {
    Footholds::Polygon touching, near;  // middles of columns
};

Footholds::Polygon hull_of_columns(const Footholds::Polygon& middles, double voxel_m) {
    Footholds::Polygon corners;
    for (const auto& [x, y] : middles)
        for (const double dx : {-voxel_m / 2, voxel_m / 2})
            for (const double dy : {-voxel_m / 2, voxel_m / 2}) corners.push_back({x + dx, y + dy});
    return physics::convex_polygon(std::move(corners));
}

}  // namespace

Footholds::Footholds(const Scene& scene)
    : axes_(rotation_of(scene.manhattan_from_input)), of_(scene.supports.size()) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> support_of;
    for (std::size_t n = 0; n < scene.supports.size(); ++n)
        support_of[{scene.supports[n].supporter, scene.supports[n].supported}] = n;
    const VoxelColumns columns(scene, axes_);
    std::vector<FootColumns> standing(scene.supports.size());
    for (std::size_t n = 1; n < columns.cells.size(); ++n) {
        const ColumnCell &below = columns.cells[n - 1], &above = columns.cells[n];
        if (below.i != above.i || below.j != above.j || below.object == above.object) continue;
        const std::int32_t gap = above.k - below.k - 1;
        if (gap > noise_gap) continue;
        const auto at = support_of.find({below.object, above.object});
        if (at == support_of.end()) continue;
        FootColumns& on = standing[at->second];
        (gap <= static_cast<std::int32_t>(contact_gap) ? on.touching : on.near)
            .push_back({columns.lowest[0] + above.i * scene.voxel_size_m,
                        columns.lowest[1] + above.j * scene.voxel_size_m});
    }
    for (std::size_t n = 0; n < standing.size(); ++n) {
        const FootColumns& on = standing[n];
        of_[n] = hull_of_columns(on.touching.empty() ? on.near : on.touching, scene.voxel_size_m);
    }
}

double Footholds::outside_m(std::span<const std::size_t> supports, const Vec3& place) const {
    Polygon corners;
    for (const std::size_t n : supports)
        corners.insert(corners.end(), of_[n].begin(), of_[n].end());
    const Polygon hull = physics::convex_polygon(std::move(corners));
    return -physics::footing(hull, dot(axes_[0], place), dot(axes_[1], place)).margin_m;
}

}  // namespace topple::safety
