// SPDX-License-Identifier: MIT
#include "geometry/cell_grid.h"

#include <algorithm>
#include <numeric>

#include "core/sorted_order.h"

namespace topple::geometry {
namespace {

constexpr std::uint64_t grid_chunk = 1 << 13;  // cells handed to a thread at once

}  // namespace

KeyGroups group_keys(std::span<const std::uint64_t> keys) {
    KeyGroups groups{sorted_order(keys), {}};
    const auto& order = groups.order;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k == 0 || keys[order[k]] != keys[order[k - 1]])
            groups.first.push_back(static_cast<std::uint32_t>(k));
    }
    groups.first.push_back(static_cast<std::uint32_t>(order.size()));
    return groups;
}

CellPacking::CellPacking(const std::array<std::int64_t, 3>& lowest,
                         const std::array<std::int64_t, 3>& highest, int reach) {
    for (std::size_t a = 0; a < 3; ++a) lowest_[a] = lowest[a] - reach;
    const auto bits = [&](std::size_t a) {
        return std::bit_width(static_cast<std::uint64_t>(highest[a] + reach - lowest_[a]));
    };
    shift_y_ = bits(2);
    shift_x_ = shift_y_ + bits(1);
}

void CellGrid::resize(std::size_t count) {
    for (auto* indices : {&x, &y, &z}) indices->resize(count);
    weight.resize(count);
    for (auto& plane : mean) plane.resize(count);
    for (auto& plane : spread) plane.resize(count);
}

CellMoments moments_of(const std::array<FloatColumn, 3>& cloud,
                       std::span<const std::uint32_t> points, const std::array<std::int32_t, 3>& at,
                       double cell_m) {
    // Sums of places are integers: a cell's edge counts as this much. Enough for 2^33 points.
    constexpr double cell_steps = 0x1p32;
    std::array<std::int64_t, 3> sum{};
    std::array<std::int64_t, 6> products{};
    const auto steps = [](double v) { return static_cast<std::int64_t>(v * cell_steps); };
    for (const std::uint32_t i : points) {
        std::array<double, 3> d{};
        for (std::size_t a = 0; a < 3; ++a) {
            d[a] = cloud[a][i] / cell_m - (static_cast<double>(at[a]) + 0.5);
            sum[a] += steps(d[a]);
            products[a] += steps(d[a] * d[a]);
        }
        products[3] += steps(d[0] * d[1]);
        products[4] += steps(d[0] * d[2]);
        products[5] += steps(d[1] * d[2]);
    }
    const double size = static_cast<double>(points.size());
    std::array<double, 3> first{};
    std::array<double, 6> second{};
    for (std::size_t a = 0; a < 3; ++a) first[a] = static_cast<double>(sum[a]) / cell_steps / size;
    for (std::size_t a = 0; a < 6; ++a)
        second[a] = static_cast<double>(products[a]) / cell_steps / size;
    CellMoments out;
    for (std::size_t a = 0; a < 3; ++a) {
        out.mean[a] = static_cast<float>(first[a]);
        out.spread[a] = static_cast<float>(second[a] - first[a] * first[a]);
    }
    out.spread[3] = static_cast<float>(second[3] - first[0] * first[1]);
    out.spread[4] = static_cast<float>(second[4] - first[0] * first[2]);
    out.spread[5] = static_cast<float>(second[5] - first[1] * first[2]);
    return out;
}

void CellGrid::set(std::size_t cell, const CellMoments& moments) {
    for (std::size_t a = 0; a < 3; ++a) mean[a][cell] = moments.mean[a];
    for (std::size_t a = 0; a < 6; ++a) spread[a][cell] = moments.spread[a];
}

CellGrid coarsen(const CellGrid& grid, ThreadPool& threads, std::vector<std::uint32_t>& parent) {
    CellGrid coarse;
    coarse.cell_m = 2 * grid.cell_m;
    parent.assign(grid.size(), 0);
    if (grid.size() == 0) return coarse;
    const auto halved = [](std::int32_t index) { return index >> 1; };
    std::array<std::int64_t, 3> lowest{}, highest{};
    const std::array<const std::vector<std::int32_t>*, 3> index{&grid.x, &grid.y, &grid.z};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto [low, high] = std::minmax_element(index[a]->begin(), index[a]->end());
        lowest[a] = halved(*low);
        highest[a] = halved(*high);
    }
    const CellPacking pack(lowest, highest);
    std::vector<std::uint64_t> keys(grid.size());
    threads.each(grid.size(), grid_chunk, [&](std::size_t i) {
        keys[i] = pack(halved(grid.x[i]), halved(grid.y[i]), halved(grid.z[i]));
    });
    const KeyGroups groups = group_keys(keys);
    coarse.resize(groups.size());
    threads.each(groups.size(), grid_chunk, [&](std::size_t cell) {
        const auto children = groups.group(cell);
        coarse.x[cell] = halved(grid.x[children[0]]);
        coarse.y[cell] = halved(grid.y[children[0]]);
        coarse.z[cell] = halved(grid.z[children[0]]);
        double sum = 0;
        std::array<double, 3> first{};
        std::array<double, 6> second{};
        for (const std::uint32_t i : children) {
            parent[i] = static_cast<std::uint32_t>(cell);
            // A child's centre lies a quarter of a coarse cell off the parent's.
            const std::array<double, 3> at{
                0.5 * grid.mean[0][i] + ((grid.x[i] & 1) != 0 ? 0.25 : -0.25),
                0.5 * grid.mean[1][i] + ((grid.y[i] & 1) != 0 ? 0.25 : -0.25),
                0.5 * grid.mean[2][i] + ((grid.z[i] & 1) != 0 ? 0.25 : -0.25)};
            const double w = grid.weight[i];
            sum += w;
            const std::array<double, 6> products{at[0] * at[0], at[1] * at[1], at[2] * at[2],
                                                 at[0] * at[1], at[0] * at[2], at[1] * at[2]};
            for (std::size_t a = 0; a < 3; ++a) first[a] += w * at[a];
            for (std::size_t a = 0; a < 6; ++a)
                second[a] += w * (products[a] + 0.25 * grid.spread[a][i]);
        }
        if (sum > 0) {
            for (double& value : first) value /= sum;
            for (double& value : second) value /= sum;
        }
        const std::array<double, 6> products{first[0] * first[0], first[1] * first[1],
                                             first[2] * first[2], first[0] * first[1],
                                             first[0] * first[2], first[1] * first[2]};
        coarse.weight[cell] = static_cast<float>(sum);
        for (std::size_t a = 0; a < 3; ++a) coarse.mean[a][cell] = static_cast<float>(first[a]);
        for (std::size_t a = 0; a < 6; ++a)
            coarse.spread[a][cell] = static_cast<float>(second[a] - products[a]);
    });
    return coarse;
}

ColumnSweep::ColumnSweep(std::span<const std::int32_t> x, std::span<const std::int32_t> y,
                         std::span<const std::int32_t> z, int radius)
    : keys_(x.size() + most_height, ~std::uint64_t{0}),
      height_(2 * static_cast<std::uint64_t>(radius) + 1) {
    if (x.empty()) return;
    std::array<std::int64_t, 3> lowest{}, highest{};
    const std::array<std::span<const std::int32_t>, 3> index{x, y, z};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto [low, high] = std::minmax_element(index[a].begin(), index[a].end());
        lowest[a] = *low;
        highest[a] = *high;
    }
    const CellPacking pack(lowest, highest, radius);
    for (std::size_t i = 0; i < x.size(); ++i) keys_[i] = pack(x[i], y[i], z[i]);
    for (int dx = -radius; dx <= radius; ++dx) {
        for (int dy = -radius; dy <= radius; ++dy) lowest_.push_back(pack.offset(dx, dy, -radius));
    }
}

std::size_t ColumnSweep::first_at(std::uint64_t key) const {
    return static_cast<std::size_t>(std::lower_bound(keys_.begin(), keys_.end(), key) -
                                    keys_.begin());
}

std::vector<std::uint32_t> column_table(const ColumnSweep& sweep,
                                        std::span<const std::uint32_t> cells, std::size_t base,
                                        ThreadPool& threads) {
    const std::size_t count = cells.size();
    std::vector<std::uint32_t> table(count * sweep.columns());
    threads.run(count, grid_chunk, [&](std::uint64_t begin, std::uint64_t end) {
        sweep.run_by_column(
            begin, end, [&](std::size_t k) { return cells[k]; },
            [&](std::size_t k, std::size_t column, std::size_t lo, std::size_t hi) {
                // An empty column may start beyond the tile; its start is never read.
                table[column * count + k] = hi > lo ? static_cast<std::uint32_t>(lo - base) |
                                                          static_cast<std::uint32_t>(hi - lo) << 28
                                                    : 0;
            });
    });
    return table;
}

void cell_neighbours(std::span<const std::int32_t> x, std::span<const std::int32_t> y,
                     std::span<const std::int32_t> z, ThreadPool& threads,
                     std::vector<std::uint32_t>& first, std::vector<std::uint32_t>& neighbours) {
    const std::size_t count = x.size();
    const ColumnSweep sweep(x, y, z, 1);
    const auto itself = [](std::size_t cell) { return cell; };
    first.assign(count + 1, 0);
    threads.run(count, grid_chunk, [&](std::uint64_t begin, std::uint64_t end) {
        sweep.run(begin, end, itself,
                  [&](std::size_t cell, std::size_t, std::size_t lo, std::size_t hi) {
                      first[cell + 1] += static_cast<std::uint32_t>(hi - lo);
                  });
        for (std::uint64_t cell = begin; cell < end; ++cell) --first[cell + 1];  // itself
    });
    std::partial_sum(first.begin(), first.end(), first.begin());
    neighbours.resize(first[count]);
    threads.run(count, grid_chunk, [&](std::uint64_t begin, std::uint64_t end) {
        std::uint32_t* to = neighbours.data() + first[begin];
        sweep.run(begin, end, itself,
                  [&](std::size_t cell, std::size_t, std::size_t lo, std::size_t hi) {
                      for (std::size_t j = lo; j < hi; ++j) {
                          if (j != cell) *to++ = static_cast<std::uint32_t>(j);
                      }
                  });
    });
}

}  // namespace topple::geometry
