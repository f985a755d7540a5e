// SPDX-License-Identifier: MIT
#include "report/part_spots.h"

#include <algorithm>
#include <array>
#include <limits>

namespace topple::report {
namespace {

constexpr std::uint8_t deep = 4;  // cells

// How many cells of its own group lie between each cell and those of others; `deep` for all that
// have more.
std::vector<std::uint8_t> depths(const std::vector<Cell>& cells, const CellTable& table) {
    std::vector<std::uint8_t> depth(cells.size(), deep);
    std::vector<std::uint32_t> ring, next;
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
        bool border = false;
        each_beside(cells[i].index, table,
                    [&](std::uint32_t other) { border |= cells[other].group != cells[i].group; });
        if (!border) continue;
        depth[i] = 0;
        ring.push_back(i);
    }
    for (std::uint8_t at = 1; at < deep; ++at, std::swap(ring, next)) {
        next.clear();
        for (const std::uint32_t i : ring) {
            each_beside(cells[i].index, table, [&](std::uint32_t other) {
                if (cells[other].group != cells[i].group || depth[other] != deep) return;
                depth[other] = at;
                next.push_back(other);
            });
        }
    }
    return depth;
}

// What a group's cells are weighed by.
struct Middle {
    std::array<double, 3> sum{};
    double count = 0;
    bool seen = false;  // whether any exposed cell was
};

bool counts(const Cell& cell, const Middle& middle) {
    return cell.exposed != 0 && !(middle.seen && cell.completed);
}

}  // namespace

std::vector<std::uint32_t> inner_cells(const std::vector<Cell>& cells, const CellTable& table,
                                       std::size_t groups) {
    const std::vector<std::uint8_t> depth = depths(cells, table);
    std::vector<Middle> middle(groups);
    for (const Cell& cell : cells)
        if (cell.exposed != 0 && !cell.completed) middle[cell.group].seen = true;
    for (const Cell& cell : cells) {
        Middle& m = middle[cell.group];
        if (!counts(cell, m)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) m.sum[axis] += cell.index[axis];
        ++m.count;
    }
    std::vector<std::uint32_t> best(groups, CellTable::absent);
    std::vector<double> least(groups, std::numeric_limits<double>::infinity());
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
        const Cell& cell = cells[i];
        const Middle& m = middle[cell.group];
        if (!counts(cell, m)) continue;
        double square = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double off = cell.index[axis] - m.sum[axis] / m.count;
            square += off * off;
        }
        std::uint32_t& found = best[cell.group];
        const bool deeper = found == CellTable::absent || depth[i] > depth[found];
        if (!deeper && (depth[i] < depth[found] || square >= least[cell.group])) continue;
        found = i;
        least[cell.group] = square;
    }
    return best;
}

std::vector<std::optional<Vec3>> nearest_points(
    const ScenePoints& points, std::span<const std::pair<std::int32_t, std::int32_t>> groups,
    std::vector<std::optional<Vec3>> places) {
    // What a parse makes is numbered from 0; numbers beyond all measure are none.
    constexpr std::int32_t limit = 1 << 24;
    std::int32_t most = -1;
    for (const auto& [primitive, object] : groups)
        if (primitive < limit) most = std::max(most, primitive);
    // A primitive has one group, but for damaged scenes, where the first one gets the point.
    std::vector<std::size_t> group_of(static_cast<std::size_t>(std::int64_t{most} + 1),
                                      groups.size());
    for (std::size_t g = groups.size(); g-- > 0;)
        if (groups[g].first >= 0 && groups[g].first <= most && places[g])
            group_of[groups[g].first] = g;
    std::vector<double> least(groups.size(), std::numeric_limits<double>::infinity());
    const std::vector<std::optional<Vec3>> wanted = places;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        if (points.primitive[i] < 0 || points.primitive[i] > most) continue;
        const std::size_t g = group_of[points.primitive[i]];
        if (g == groups.size()) continue;
        const Vec3 p{points.x[i], points.y[i], points.z[i]};
        double square = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            square += (p[axis] - (*wanted[g])[axis]) * (p[axis] - (*wanted[g])[axis]);
        if (!(square < least[g])) continue;
        least[g] = square;
        places[g] = p;
    }
    return places;
}

}  // namespace topple::report
