// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/depth_noise.h"
#include "device/devices.h"
#include "geometry/cell_grid.h"
#include "geometry/plane_fit.h"
#include "points/frames_cells.h"

namespace topple::geometry {
namespace {

constexpr std::uint8_t most_fused_levels = 3, stays = 255;
constexpr std::uint64_t fused_chunk = 1 << 15;  // cells handed to a thread at once

// What lies in the 27 cells around a cell, its own among them.
struct Around {
    std::uint64_t cells = 0, count = 0, weight = 0;
};

// Calls visit(cell, around) for each of n cells, cell(i), by ascending key. Each of the nine
// columns of three is a run of sorted cells whose ends only move up, and the difference of two
// running sums is what it holds.
template <class Cell, class Visit>
void visit_surroundings(std::size_t n, ThreadPool& pool, const Cell& cell, const Visit& visit) {
    // Behind the last come more keys than a run has, above all.
    std::vector<std::uint64_t> key(n + 3, ~std::uint64_t{0}), count(n + 1), weight(n + 1);
    pool.each(n, fused_chunk, [&](std::size_t i) {
        const CellSums& at = cell(i);
        key[i] = at.key;
        count[i + 1] = at.count;
        weight[i + 1] = at.weight;
    });
    std::partial_sum(count.begin(), count.end(), count.begin());
    std::partial_sum(weight.begin(), weight.end(), weight.begin());
    pool.run(n, fused_chunk, [&](std::uint64_t first, std::uint64_t last) {
        std::array<std::uint64_t, 9> lowest{};  // of each column, relative to the cell's key
        std::array<std::size_t, 9> lo{};
        for (std::size_t c = 0; c < 9; ++c) {
            lowest[c] = ((c / 3) << key_shift[0]) + ((c % 3) << key_shift[1]) -
                        ((1ull << key_shift[0]) + (1ull << key_shift[1]) + 1);
            lo[c] = static_cast<std::size_t>(
                std::lower_bound(key.begin(), key.end() - 3, key[first] + lowest[c]) - key.begin());
        }
        for (std::uint64_t i = first; i < last; ++i) {
            Around around;
            for (std::size_t c = 0; c < 9; ++c) {
                // Mostly one or two on; which of them no branch foretells.
                const std::uint64_t low = key[i] + lowest[c];
                std::size_t at = lo[c];
                at += key[at] < low;
                at += key[at] < low;
                while (key[at] < low) ++at;
                lo[c] = at;
                const std::size_t end =
                    at + (key[at] < low + 3) + (key[at + 1] < low + 3) + (key[at + 2] < low + 3);
                around.cells += end - at;
                around.count += count[end] - count[at];
                around.weight += weight[end] - weight[at];
            }
            visit(static_cast<std::size_t>(i), around);
        }
    });
}

void drop_cells(FusedCells& fused, const std::vector<std::uint8_t>& drop) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < drop.size(); ++i) {
        if (drop[i] == 0) fused.cells[kept++] = fused.cells[i];
    }
    fused.cells.resize(kept);
}

// The level of the grid, from 0 for its own cells, at which each cell's plane is fitted. Readings
// spread by sigma to both sides; a neighbourhood must be wider than that to see which way the
// surface runs. Coarser grids give the wider ones.
std::uint8_t level_for(double sigma, double cell_m) {
    std::uint8_t level = 0;
    while (level < most_fused_levels && 3 * sigma > 2.5 * cell_m * (1 << level)) ++level;
    return level;
}

CellGrid grid_of(const FusedCells& fused, ThreadPool& pool) {
    CellGrid grid;
    grid.cell_m = fused.cell_m;
    grid.resize(fused.cells.size(), false);
    pool.each(fused.cells.size(), fused_chunk, [&](std::size_t i) {
        const CellSums& cell = fused.cells[i];
        const std::array<std::int32_t*, 3> index{&grid.x[i], &grid.y[i], &grid.z[i]};
        for (std::size_t a = 0; a < 3; ++a) {
            *index[a] = static_cast<std::int32_t>(index_in(cell.key, a) - key_bias);
            grid.mean[a][i] = static_cast<float>(mean_offset(cell, a) / cell_parts - 0.5);
        }
        grid.weight[i] = static_cast<float>(static_cast<double>(cell.weight) / 65535);
    });
    return grid;
}

// Where a cell's mean lies, in cells from the grid's lowest corner.
std::array<double, 3> mean_of(const CellSums& cell) {
    std::array<double, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
        at[a] = static_cast<double>(index_in(cell.key, a)) + mean_offset(cell, a) / cell_parts;
    }
    return at;
}

void move_to(CellSums& cell, const std::array<double, 3>& at) {
    std::array<std::uint64_t, 3> index{};
    for (std::size_t a = 0; a < 3; ++a) {
        const double whole = std::floor(at[a]);
        index[a] = static_cast<std::uint64_t>(whole);
        cell.offset[a] = cell.weight * static_cast<std::uint64_t>((at[a] - whole) * cell_parts);
    }
    cell.key = key_of(index);
}

// Moves the cells `which` onto the planes fitted in the grid of one level, whose cell is cell_of
// for each. A plane is fitted at the mean of a level's cell and serves all that it was made from:
// that mean lies nearer the surface than its outer layers do, and there are far fewer.
void flatten_level(FusedCells& fused, const CellGrid& grid, double scale,
                   const std::vector<std::uint32_t>& which,
                   const std::vector<std::uint32_t>& cell_of, const std::vector<float>& sigma,
                   device::Device& device, ThreadPool& pool) {
    std::vector<std::uint32_t> query_of(grid.size());
    for (const std::uint32_t i : which) query_of[cell_of[i]] = 1;
    PlaneQueries queries;
    for (std::size_t cell = 0; cell < grid.size(); ++cell) {
        if (query_of[cell] == 0) continue;
        query_of[cell] = static_cast<std::uint32_t>(queries.cell.size());
        queries.cell.push_back(static_cast<std::uint32_t>(cell));
        for (std::size_t a = 0; a < 3; ++a) queries.at[a].push_back(grid.mean[a][cell]);
    }
    PlaneFitter fitter(device, grid, std::move(queries));
    const PlaneFit fit = fitter.fit({});
    const std::vector<float> offsets = fitter.mean_offsets(fit);
    pool.each(which.size(), fused_chunk, [&](std::size_t k) {
        CellSums& cell = fused.cells[which[k]];
        const std::uint32_t home = cell_of[which[k]], q = query_of[home];
        const std::array<std::int32_t, 3> index{grid.x[home], grid.y[home], grid.z[home]};
        const std::array<double, 3> at = mean_of(cell);
        double offset = offsets[q];  // from the cell to the surface, cells of the level
        for (std::size_t a = 0; a < 3; ++a) {
            const double from_query = (at[a] - static_cast<double>(key_bias)) / scale -
                                      (index[a] + 0.5 + double{grid.mean[a][home]});
            offset -= double{fit.normal[a][q]} * from_query;
        }
        const double noise = sigma[which[k]] / grid.cell_m;
        // An edge or a small thing is rougher than the readings' noise, and stays.
        if (fit.rms[q] > 1.5 * noise + 0.1 || std::abs(offset) > 3 * noise + 0.1) return;
        std::array<double, 3> moved = at;
        for (std::size_t a = 0; a < 3; ++a) moved[a] += double{fit.normal[a][q]} * offset * scale;
        move_to(cell, moved);
    });
}

// Sorts the cells by key and sums up those of one key.
void bin_anew(FusedCells& fused, ThreadPool& pool) {
    CellTables tables;
    constexpr std::size_t most_parts = 64;
    std::vector<std::span<const CellSums>> parts;
    const std::span<const CellSums> cells(fused.cells.data(), fused.cells.size());
    const std::size_t part = std::max(fused_chunk, cells.size() / most_parts + 1);
    for (std::size_t first = 0; first < cells.size(); first += part)
        parts.push_back(cells.subspan(first, std::min(part, cells.size() - first)));
    tables.add(parts, pool);
    const CellPlaces sorted = tables.sorted(pool);
    fused.cells = {};  // before there are others
    fused.cells = SortedCells(sorted.size(), boost::container::default_init);
    pool.each(sorted.size(), fused_chunk, [&](std::size_t i) { fused.cells[i] = *sorted[i]; });
}

}  // namespace

SortedCells strong_cells(const CellPlaces& cells, std::size_t frames, ThreadPool& pool) {
    std::vector<std::uint8_t> weak(cells.size());
    const auto cell_at = [&](std::size_t i) -> const CellSums& { return *cells[i]; };
    visit_surroundings(cells.size(), pool, cell_at, [&](std::size_t i, const Around& all) {
        const CellSums& cell = *cells[i];
        const auto around = static_cast<double>(all.cells - 1),
                   count = static_cast<double>(all.count - cell.count),
                   weight = static_cast<double>(all.weight - cell.weight);
        const bool lonely = around == 0 && cell.count == 1 && frames > 1;
        // Below a tenth of its surroundings by readings and by certainty.
        const bool below = around > 0 && 10.0 * cell.count < count / around &&
                           10.0 * static_cast<double>(cell.weight) < weight / around;
        weak[i] = lonely || below;
    });
    std::vector<std::uint32_t> stay;
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (weak[i] == 0) stay.push_back(static_cast<std::uint32_t>(i));
    SortedCells strong(stay.size(), boost::container::default_init);
    pool.each(stay.size(), fused_chunk, [&](std::size_t n) { strong[n] = *cells[stay[n]]; });
    return strong;
}

void drop_denied(FusedCells& fused, const Witnesses& witnesses, ThreadPool& pool) {
    const std::size_t n = fused.cells.size();
    FusedPoints points;
    for (std::vector<float>* values : {&points.x, &points.y, &points.z, &points.sigma})
        values->resize(n);
    pool.each(n, fused_chunk, [&](std::size_t i) {
        const std::array<double, 3> at = mean_of(fused.cells[i]);
        constexpr auto bias = static_cast<double>(key_bias);
        points.x[i] = static_cast<float>((at[0] - bias) * fused.cell_m);
        points.y[i] = static_cast<float>((at[1] - bias) * fused.cell_m);
        points.z[i] = static_cast<float>((at[2] - bias) * fused.cell_m);
        points.sigma[i] =
            static_cast<float>(least_depth_sigma * std::sqrt(65535.0 / fused.cells[i].best_weight));
    });
    drop_cells(fused, witnesses.deny(points, pool));
}

void flatten_layers(FusedCells& fused, double least_sigma_m, ThreadPool& pool) {
    const std::size_t n = fused.cells.size();
    std::vector<float> sigma(n);  // of the readings in and around each cell, metres
    std::vector<std::uint8_t> level_of(n);
    const auto cell_at = [&](std::size_t i) -> const CellSums& { return fused.cells[i]; };
    visit_surroundings(n, pool, cell_at, [&](std::size_t i, const Around& around) {
        const double s = least_depth_sigma * std::sqrt(65535 * static_cast<double>(around.count) /
                                                       static_cast<double>(around.weight));
        sigma[i] = static_cast<float>(s);
        level_of[i] = s < least_sigma_m ? stays : level_for(s, fused.cell_m);
    });
    std::array<std::vector<std::uint32_t>, most_fused_levels + 1> which;
    for (std::size_t i = 0; i < n; ++i) {
        if (level_of[i] != stays) which[level_of[i]].push_back(static_cast<std::uint32_t>(i));
    }
    std::size_t left = 0;
    for (const auto& cells : which) left += cells.size();
    if (left == 0) return;
    const std::unique_ptr<device::Device> device = device::open_native(pool.threads());
    CellGrid grid = grid_of(fused, pool);
    std::vector<std::uint32_t> cell_of(n);  // the level's cell of each cell
    std::iota(cell_of.begin(), cell_of.end(), 0u);
    for (std::size_t level = 0; left > 0; ++level) {
        if (level > 0) {
            std::vector<std::uint32_t> parent;
            grid = coarsen(grid, pool, parent);
            pool.each(n, fused_chunk, [&](std::size_t i) { cell_of[i] = parent[cell_of[i]]; });
        }
        if (which[level].empty()) continue;
        flatten_level(fused, grid, static_cast<double>(1 << level), which[level], cell_of, sigma,
                      *device, pool);
        left -= which[level].size();
    }
    grid = {};
    bin_anew(fused, pool);
}

}  // namespace topple::geometry
