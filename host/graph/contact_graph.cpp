// SPDX-License-Identifier: MIT
#include "graph/contact_graph.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "physics/tipping.h"

namespace topple::graph {
namespace {

using physics::SolidCells;

// Areas seen along one axis: each line of cells along it counts once for every primitive on it.
void add_silhouettes(const SolidCells& cells, std::span<const std::int32_t> u,
                     std::span<const std::int32_t> v, std::size_t axis, ContactGraph& graph) {
    std::vector<std::size_t> order(cells.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto key = [&](std::size_t n) { return std::tuple(cells.primitive[n], u[n], v[n]); };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
    const double face = cells.voxel_m * cells.voxel_m;
    for (std::size_t n = 0; n < order.size(); ++n) {
        const std::int32_t p = cells.primitive[order[n]];
        if (p >= 0 && (n == 0 || key(order[n]) != key(order[n - 1]))) {
            graph.silhouette_m2[static_cast<std::size_t>(p)][axis] += face;
        }
    }
}

struct Columns {
    std::vector<std::array<double, 2>> corners;
    std::uint64_t count = 0;
    double height_sum = 0;
};

}  // namespace

std::span<const Carrying> ContactGraph::carriers_of(std::int32_t primitive) const {
    const auto [first, last] =
        std::ranges::equal_range(carryings, primitive, {}, &Carrying::supported);
    return {first, last};
}

ContactGraph build_contact_graph(device::Device& device, const SolidCells& cells,
                                 std::int32_t primitives, unsigned gap) {
    ContactGraph graph;
    graph.primitives = primitives;
    const auto count = static_cast<std::size_t>(primitives);
    graph.silhouette_m2.assign(count, {0, 0, 0});
    graph.clearances.resize(count);
    graph.lowest_m.assign(count, std::numeric_limits<double>::infinity());
    graph.highest_m.assign(count, -std::numeric_limits<double>::infinity());
    graph.pairs = physics::touching_pairs(device, cells, primitives, gap);
    add_silhouettes(cells, cells.j, cells.k, 0, graph);
    add_silhouettes(cells, cells.i, cells.k, 1, graph);
    add_silhouettes(cells, cells.i, cells.j, 2, graph);

    const double h = cells.voxel_m;
    std::map<std::pair<std::int32_t, std::int32_t>, Columns> carried;  // (supported, supporter)
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> gaps;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t upper = cells.primitive[n];
        if (upper < 0) continue;
        const auto p = static_cast<std::size_t>(upper);
        graph.lowest_m[p] = std::min(graph.lowest_m[p], cells.k[n] * h);
        graph.highest_m[p] = std::max(graph.highest_m[p], (cells.k[n] + 1) * h);
        // Cells are sorted by (i, j, k): the one below in the column, if any, comes right before.
        if (n == 0 || cells.i[n - 1] != cells.i[n] || cells.j[n - 1] != cells.j[n]) continue;
        const std::int32_t lower = cells.primitive[n - 1];
        if (lower == upper) continue;
        const std::int32_t empty = cells.k[n] - cells.k[n - 1] - 1;
        const auto [at, fresh] = gaps.try_emplace({upper, lower}, empty);
        if (!fresh) at->second = std::min(at->second, empty);
        if (empty > static_cast<std::int32_t>(gap)) continue;
        Columns& columns = carried[{upper, lower}];
        ++columns.count;
        columns.height_sum += (cells.k[n - 1] + 1) * h;
        for (const int di : {0, 1}) {
            for (const int dj : {0, 1})
                columns.corners.push_back({(cells.i[n] + di) * h, (cells.j[n] + dj) * h});
        }
    }
    for (const auto& [key, columns] : carried) {
        graph.carryings.push_back({key.second, key.first,
                                   static_cast<double>(columns.count) * h * h,
                                   columns.height_sum / static_cast<double>(columns.count),
                                   physics::convex_polygon(columns.corners)});
    }
    for (const auto& [key, empty] : gaps) {
        graph.clearances[static_cast<std::size_t>(key.first)].push_back({key.second, empty * h});
    }
    return graph;
}

}  // namespace topple::graph
