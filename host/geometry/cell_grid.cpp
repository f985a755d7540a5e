// SPDX-License-Identifier: MIT
#include "geometry/cell_grid.h"

#include <algorithm>
#include <numeric>

namespace topple::geometry {
namespace {

// Calls visit(cell, lo, hi) for each cell of [first, last) with the cells [lo, hi) whose x and y
// are its own plus (dx, dy) and whose z is within `radius` of its own. Cells are sorted, so both
// ends only move up.
template <class Visit>
void sweep_column(std::span<const std::int32_t> x, std::span<const std::int32_t> y,
                  std::span<const std::int32_t> z, std::int64_t dx, std::int64_t dy,
                  std::int64_t radius, std::size_t first, std::size_t last, Visit visit) {
    const std::size_t count = x.size();
    const auto before = [&](std::size_t cell, std::int64_t cx, std::int64_t cy, std::int64_t cz) {
        if (x[cell] != cx) return x[cell] < cx;
        if (y[cell] != cy) return y[cell] < cy;
        return z[cell] < cz;
    };
    // The first cell of the sweep is found by bisection, the rest by walking on.
    std::size_t lo = 0, step = count;
    while (step > 0 && first < last) {
        const std::size_t half = step / 2;
        if (before(lo + half, x[first] + dx, y[first] + dy, z[first] - radius)) {
            lo += half + 1;
            step -= half + 1;
        } else {
            step = half;
        }
    }
    std::size_t hi = lo;
    for (std::size_t cell = first; cell < last; ++cell) {
        const std::int64_t cx = x[cell] + dx, cy = y[cell] + dy;
        while (lo < count && before(lo, cx, cy, z[cell] - radius)) ++lo;
        hi = std::max(hi, lo);
        while (hi < count && before(hi, cx, cy, z[cell] + radius + 1)) ++hi;
        visit(cell, lo, hi);
    }
}

}  // namespace

std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> keys) {
    struct Item {
        std::uint64_t key;
        std::uint32_t index;
    };
    std::vector<Item> items(keys.size()), other(keys.size());
    std::uint64_t any = 0, all = ~std::uint64_t{0};
    for (std::size_t i = 0; i < keys.size(); ++i) {
        items[i] = {keys[i], static_cast<std::uint32_t>(i)};
        any |= keys[i];
        all &= keys[i];
    }
    constexpr unsigned bits = 11;
    for (unsigned shift = 0; shift < 64; shift += bits) {
        constexpr std::uint64_t mask = (1u << bits) - 1;
        if (((any ^ all) >> shift & mask) == 0) continue;  // all keys agree here
        std::array<std::size_t, (1u << bits) + 1> start{};
        for (const Item& item : items) ++start[(item.key >> shift & mask) + 1];
        std::partial_sum(start.begin(), start.end(), start.begin());
        for (const Item& item : items) other[start[item.key >> shift & mask]++] = item;
        items.swap(other);
    }
    std::vector<std::uint32_t> order(keys.size());
    for (std::size_t i = 0; i < items.size(); ++i) order[i] = items[i].index;
    return order;
}

void CellGrid::resize(std::size_t count) {
    for (auto* indices : {&x, &y, &z}) indices->resize(count);
    weight.resize(count);
    for (auto& plane : mean) plane.resize(count);
    for (auto& plane : spread) plane.resize(count);
}

CellGrid coarsen(const CellGrid& grid, std::vector<std::uint32_t>& parent) {
    CellGrid coarse;
    coarse.cell_m = 2 * grid.cell_m;
    parent.assign(grid.size(), 0);
    if (grid.size() == 0) return coarse;
    CellPacking pack;
    const auto halved = [](std::int32_t index) { return index >> 1; };
    pack.lowest = {halved(*std::min_element(grid.x.begin(), grid.x.end())),
                   halved(*std::min_element(grid.y.begin(), grid.y.end())),
                   halved(*std::min_element(grid.z.begin(), grid.z.end()))};
    std::vector<std::uint64_t> keys(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i) {
        keys[i] = pack(halved(grid.x[i]), halved(grid.y[i]), halved(grid.z[i]));
    }
    const std::vector<std::uint32_t> order = sorted_order(keys);
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && keys[order[end]] == keys[order[begin]]) ++end;
        const auto cell = static_cast<std::uint32_t>(coarse.size());
        coarse.resize(cell + std::size_t{1});
        const std::uint32_t one = order[begin];
        coarse.x[cell] = halved(grid.x[one]);
        coarse.y[cell] = halved(grid.y[one]);
        coarse.z[cell] = halved(grid.z[one]);
        double sum = 0;
        std::array<double, 3> first{};
        std::array<double, 6> second{};
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = order[k];
            parent[i] = cell;
            // A child's centre lies a quarter of a coarse cell off the parent's.
            const std::array<double, 3> at{
                0.5 * grid.mean[0][i] + ((grid.x[i] & 1) != 0 ? 0.25 : -0.25),
                0.5 * grid.mean[1][i] + ((grid.y[i] & 1) != 0 ? 0.25 : -0.25),
                0.5 * grid.mean[2][i] + ((grid.z[i] & 1) != 0 ? 0.25 : -0.25)};
            const double w = grid.weight[i];
            sum += w;
            constexpr std::array<std::array<int, 2>, 6> pairs{
                {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
            for (std::size_t a = 0; a < 3; ++a) first[a] += w * at[a];
            for (std::size_t a = 0; a < 6; ++a) {
                second[a] += w * (at[static_cast<std::size_t>(pairs[a][0])] *
                                      at[static_cast<std::size_t>(pairs[a][1])] +
                                  0.25 * grid.spread[a][i]);
            }
        }
        if (sum > 0) {
            for (double& value : first) value /= sum;
            for (double& value : second) value /= sum;
        }
        coarse.weight[cell] = static_cast<float>(sum);
        for (std::size_t a = 0; a < 3; ++a) coarse.mean[a][cell] = static_cast<float>(first[a]);
        coarse.spread[0][cell] = static_cast<float>(second[0] - first[0] * first[0]);
        coarse.spread[1][cell] = static_cast<float>(second[1] - first[1] * first[1]);
        coarse.spread[2][cell] = static_cast<float>(second[2] - first[2] * first[2]);
        coarse.spread[3][cell] = static_cast<float>(second[3] - first[0] * first[1]);
        coarse.spread[4][cell] = static_cast<float>(second[4] - first[0] * first[2]);
        coarse.spread[5][cell] = static_cast<float>(second[5] - first[1] * first[2]);
    }
    return coarse;
}

std::vector<std::uint32_t> column_table(const CellGrid& grid, int radius, std::size_t first,
                                        std::size_t last, std::size_t base) {
    const std::size_t count = last - first;
    const int side = 2 * radius + 1;
    std::vector<std::uint32_t> table(count * static_cast<std::size_t>(side * side));
    std::uint32_t* plane = table.data();
    for (int dx = -radius; dx <= radius; ++dx) {
        for (int dy = -radius; dy <= radius; ++dy, plane += count) {
            sweep_column(grid.x, grid.y, grid.z, dx, dy, radius, first, last,
                         [&](std::size_t cell, std::size_t lo, std::size_t hi) {
                             // An empty column may start beyond the tile; its start is never read.
                             plane[cell - first] = hi > lo ? static_cast<std::uint32_t>(lo - base) |
                                                                 static_cast<std::uint32_t>(hi - lo)
                                                                     << 29
                                                           : 0;
                         });
        }
    }
    return table;
}

void cell_neighbours(std::span<const std::int32_t> x, std::span<const std::int32_t> y,
                     std::span<const std::int32_t> z, std::vector<std::uint32_t>& first,
                     std::vector<std::uint32_t>& neighbours) {
    const std::size_t count = x.size();
    first.assign(count + 1, 0);
    for (int pass = 0; pass < 2; ++pass) {
        // Pass 0 counts, pass 1 fills; `at` then runs through each cell's part of the list.
        std::vector<std::uint32_t> at(first.begin(), first.end() - 1);
        for (int dx = -1; dx <= 1; ++dx) {
            for (int dy = -1; dy <= 1; ++dy) {
                sweep_column(x, y, z, dx, dy, 1, 0, count,
                             [&](std::size_t cell, std::size_t lo, std::size_t hi) {
                                 for (std::size_t j = lo; j < hi; ++j) {
                                     if (j == cell) continue;
                                     if (pass == 0) {
                                         ++first[cell + 1];
                                     } else {
                                         neighbours[at[cell]++] = static_cast<std::uint32_t>(j);
                                     }
                                 }
                             });
            }
        }
        if (pass == 0) {
            std::partial_sum(first.begin(), first.end(), first.begin());
            neighbours.resize(first[count]);
        }
    }
}

}  // namespace topple::geometry
