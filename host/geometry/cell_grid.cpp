// SPDX-License-Identifier: MIT
#include "geometry/cell_grid.h"

#include <algorithm>
#include <numeric>

#include "core/sorted_order.h"

namespace topple::geometry {
namespace {

constexpr std::uint64_t grid_chunk = 1 << 13;  // cells handed to a thread at once

}  // namespace

KeyGroups group_keys(std::span<const std::uint64_t> keys, ThreadPool& threads) {
    KeyGroups groups{sorted_order(keys, threads), {}};
    const auto& order = groups.order;
    std::vector<std::uint8_t> begins(order.size());
    threads.each(order.size(), grid_chunk, [&](std::size_t k) {
        begins[k] = k == 0 || keys[order[k]] != keys[order[k - 1]];
    });
    for (std::size_t k = 0; k < order.size(); ++k)
        if (begins[k] != 0) groups.first.push_back(static_cast<std::uint32_t>(k));
    groups.first.push_back(static_cast<std::uint32_t>(order.size()));
    return groups;
}

KeyGroups group_keys(std::span<const std::uint64_t> keys) {
    ThreadPool alone(1);
    return group_keys(keys, alone);
}

CellPacking::CellPacking(const GridCell& lowest, const GridCell& highest, int reach) {
    for (std::size_t a = 0; a < 3; ++a) lowest_[a] = lowest[a] - reach;
    const auto bits = [&](std::size_t a) {
        return std::bit_width(static_cast<std::uint64_t>(highest[a] + reach - lowest_[a]));
    };
    shift_y_ = bits(2);
    shift_x_ = shift_y_ + bits(1);
}

void CellGrid::resize(std::size_t count, bool with_spread) {
    for (auto* indices : {&x, &y, &z}) indices->resize(count);
    weight.resize(count);
    for (auto& plane : mean) plane.resize(count);
    for (auto& plane : spread) plane.resize(with_spread ? count : 0);
}

namespace {

// As spreads are: xx yy zz xy xz yz.
std::array<double, 6> products_of(const std::array<double, 3>& d) {
    return {d[0] * d[0], d[1] * d[1], d[2] * d[2], d[0] * d[1], d[0] * d[2], d[1] * d[2]};
}

}  // namespace

void MomentSums::add(double w, const std::array<double, 3>& at,
                     const std::array<double, 6>& spread) {
    const std::array<double, 6> products = products_of(at);
    weight += w;
    for (std::size_t a = 0; a < 3; ++a) first[a] += w * at[a];
    for (std::size_t a = 0; a < 6; ++a) second[a] += w * (products[a] + spread[a]);
}

CellMoments MomentSums::moments() const {
    const double all = weight > 0 ? weight : 1;
    std::array<double, 3> mean = first;
    for (double& value : mean) value /= all;
    const std::array<double, 6> products = products_of(mean);
    CellMoments out;
    for (std::size_t a = 0; a < 3; ++a) out.mean[a] = static_cast<float>(mean[a]);
    for (std::size_t a = 0; a < 6; ++a)
        out.spread[a] = static_cast<float>(second[a] / all - products[a]);
    return out;
}

CellMoments moments_of(const std::array<FloatColumn, 3>& cloud,
                       std::span<const std::uint32_t> points, const Place& at, double cell_m) {
    // Sums of places are integers: a cell's edge counts as this much. Enough for 2^33 points.
    constexpr double cell_steps = 0x1p32;
    std::array<std::int64_t, 3> sum{};
    std::array<std::int64_t, 6> sum_of_products{};
    const auto steps = [](double v) { return static_cast<std::int64_t>(v * cell_steps); };
    for (const std::uint32_t i : points) {
        std::array<double, 3> d{};
        for (std::size_t a = 0; a < 3; ++a) {
            d[a] = cloud[a][i] / cell_m - (static_cast<double>(at[a]) + 0.5);
            sum[a] += steps(d[a]);
        }
        const std::array<double, 6> products = products_of(d);
        for (std::size_t a = 0; a < 6; ++a) sum_of_products[a] += steps(products[a]);
    }
    MomentSums sums{static_cast<double>(points.size())};
    for (std::size_t a = 0; a < 3; ++a) sums.first[a] = static_cast<double>(sum[a]) / cell_steps;
    for (std::size_t a = 0; a < 6; ++a)
        sums.second[a] = static_cast<double>(sum_of_products[a]) / cell_steps;
    return sums.moments();
}

void CellGrid::set_index(std::size_t cell, const GridCell& at) {
    x[cell] = static_cast<std::int32_t>(at[0]);
    y[cell] = static_cast<std::int32_t>(at[1]);
    z[cell] = static_cast<std::int32_t>(at[2]);
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
    const auto halved = [&](std::size_t i) {
        return GridCell{grid.x[i] >> 1, grid.y[i] >> 1, grid.z[i] >> 1};
    };
    const KeyGroups groups = group_cells(grid.size(), halved, threads);
    coarse.resize(groups.size());
    threads.each(groups.size(), grid_chunk, [&](std::size_t cell) {
        const auto children = groups.group(cell);
        MomentSums sums;
        for (const std::uint32_t i : children) {
            parent[i] = static_cast<std::uint32_t>(cell);
            // A child's centre lies a quarter of a coarse cell off the parent's.
            const Place index = grid.index(i);
            std::array<double, 3> at{};
            std::array<double, 6> spread{};
            for (std::size_t a = 0; a < 3; ++a)
                at[a] = 0.5 * grid.mean[a][i] + ((index[a] & 1) != 0 ? 0.25 : -0.25);
            for (std::size_t a = 0; a < 6 && !grid.spread[a].empty(); ++a)
                spread[a] = 0.25 * grid.spread[a][i];
            sums.add(grid.weight[i], at, spread);
        }
        coarse.set_index(cell, halved(children[0]));
        coarse.weight[cell] = static_cast<float>(sums.weight);
        coarse.set(cell, sums.moments());
    });
    return coarse;
}

ColumnSweep::ColumnSweep(std::span<const std::int32_t> x, std::span<const std::int32_t> y,
                         std::span<const std::int32_t> z, int radius)
    : keys_(x.size() + most_height, ~std::uint64_t{0}),
      height_(2 * static_cast<std::uint64_t>(radius) + 1) {
    if (x.empty()) return;
    const auto cell = [&](std::size_t i) { return GridCell{x[i], y[i], z[i]}; };
    const CellPacking pack = CellPacking::of(x.size(), cell, radius);
    for (std::size_t i = 0; i < x.size(); ++i) keys_[i] = pack(cell(i));
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
