// SPDX-License-Identifier: MIT
#include "export/surface_colours.h"

#include <algorithm>
#include <cmath>

#include "core/rotation.h"

namespace topple {
namespace {

using Cell = std::array<std::int32_t, 3>;

Cell cell_at(const vdb::VoxelFrame& frame, const ScenePoints& points, std::size_t i) {
    const Vec3 p = frame.grid_of({points.x[i], points.y[i], points.z[i]});
    Cell out{};
    for (std::size_t a = 0; a < 3; ++a) {
        out[a] = static_cast<std::int32_t>(std::clamp(std::floor(p[a] / frame.voxel_m), -1e9, 1e9));
    }
    return out;
}

}  // namespace

SurfaceColours::SurfaceColours(const ScenePoints& points, const SolidCells& cells,
                               std::span<const std::int32_t> object_of_primitive,
                               const vdb::VoxelFrame& frame) {
    std::vector<Cell> index;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const Cell cell{cells.i[n], cells.j[n], cells.k[n]};
        if (n == 0) first_ = cell;
        table_.insert(moved(cell), static_cast<std::uint32_t>(n));
        index.push_back(moved(cell));
        const std::int32_t p = cells.primitive[n];
        const bool known = p >= 0 && static_cast<std::size_t>(p) < object_of_primitive.size();
        object_.push_back(known ? object_of_primitive[p] : -1);
    }
    report::CellColours colours(index.size());
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        const std::uint32_t found = table_.find(moved(cell_at(frame, points, i)));
        if (found == report::CellTable::absent || object_[found] != points.object[i]) continue;
        colours.add(found, {points.red[i], points.green[i], points.blue[i]});
    }
    seen_ = colours.spread(table_, index, object_);
}

std::optional<Rgb8> SurfaceColours::at(const Cell& corner, std::int32_t object) const {
    for (const std::int32_t reach : {1, 2}) {
        ColourSum seen;
        for (std::int32_t i = -reach; i < reach; ++i) {
            for (std::int32_t j = -reach; j < reach; ++j) {
                for (std::int32_t k = -reach; k < reach; ++k) {
                    const std::uint32_t found =
                        table_.find(moved({corner[0] + i, corner[1] + j, corner[2] + k}));
                    if (found == report::CellTable::absent || object_[found] != object ||
                        !seen_[found])
                        continue;
                    seen.add(*seen_[found]);
                }
            }
        }
        if (seen.count > 0) return seen.mean();
    }
    return std::nullopt;
}

// The table's indices are small.
Cell SurfaceColours::moved(const Cell& cell) const {
    Cell out{};
    for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t from_first = std::int64_t{cell[a]} - first_[a];
        out[a] = static_cast<std::int32_t>(
            std::clamp<std::int64_t>(from_first, -(1 << 20) + 2, (1 << 20) - 2));
    }
    return out;
}

}  // namespace topple
