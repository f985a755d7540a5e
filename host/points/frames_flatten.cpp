// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/depth_noise.h"
#include "device/devices.h"
#include "geometry/cell_grid.h"
#include "geometry/plane_fit.h"
#include "points/cell_surroundings.h"
#include "points/frames_cells.h"

namespace topple::geometry {
namespace {

constexpr std::uint8_t most_fused_levels = 3, stays = 255;

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
        const CellSums& cell = cell_at(fused.cells, i);
        const std::array<std::int32_t*, 3> index{&grid.x[i], &grid.y[i], &grid.z[i]};
        for (std::size_t a = 0; a < 3; ++a) {
            *index[a] = static_cast<std::int32_t>(index_in(cell.key, a) - key_bias);
            grid.mean[a][i] = static_cast<float>(mean_offset(cell, a) / cell_parts - 0.5);
        }
        grid.weight[i] = static_cast<float>(static_cast<double>(cell.weight) / 65535);
    });
    return grid;
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

// Calls use(from, to) for each column of two grids.
template <class Use>
void each_column(const CellGrid& from, CellGrid& to, const Use& use) {
    use(from.x, to.x);
    use(from.y, to.y);
    use(from.z, to.z);
    use(from.weight, to.weight);
    for (std::size_t a = 0; a < from.mean.size(); ++a) use(from.mean[a], to.mean[a]);
    for (std::size_t a = 0; a < from.spread.size(); ++a) use(from.spread[a], to.spread[a]);
}

// The cells [first, last) of a grid.
CellGrid part_of(const CellGrid& grid, std::size_t first, std::size_t last) {
    CellGrid out;
    out.cell_m = grid.cell_m;
    each_column(grid, out, [&](const auto& from, auto& to) {
        if (from.empty()) return;
        const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
        to.assign(begin, begin + static_cast<std::ptrdiff_t>(last - first));
    });
    return out;
}

std::size_t first_cell_at(const CellGrid& grid, std::int32_t x) {
    return static_cast<std::size_t>(std::ranges::lower_bound(grid.x, x) - grid.x.begin());
}
// Where the slab ends that begins at the x of a cell; in whole coarser cells, for those.
std::int32_t end_of_slab(const CellGrid& grid, std::size_t first) {
    const std::size_t beyond = first + slab_cells;
    if (beyond >= grid.size()) return grid.x.back() + 1;
    return std::max(grid.x[beyond] & ~1, (grid.x[first] & ~1) + 2);
}

CellGrid coarsen_by_slabs(const CellGrid& grid, ThreadPool& pool,
                          std::vector<std::uint32_t>& parent) {
    CellGrid out;
    out.cell_m = 2 * grid.cell_m;
    parent.clear();
    parent.reserve(grid.size());
    // Of more than is needed nothing is touched; copies made in growing would be.
    each_column(grid, out, [&](const auto&, auto& to) { to.reserve(grid.size()); });
    for (std::size_t from = 0; from < grid.size();) {
        const std::size_t to = first_cell_at(grid, end_of_slab(grid, from));
        std::vector<std::uint32_t> within;
        const CellGrid coarse = coarsen(part_of(grid, from, to), pool, within);
        const auto before = static_cast<std::uint32_t>(out.size());
        for (const std::uint32_t cell : within) parent.push_back(before + cell);
        each_column(coarse, out, [](const auto& some, auto& all) {
            all.insert(all.end(), some.begin(), some.end());
        });
        from = to;
    }
    return out;
}

// Cells to flatten, of one level.
struct FlattenedLevel {
    const CellGrid& grid;
    double scale;                               // its cells' edge, in fused cells
    const std::vector<std::uint32_t>& which;    // fused cells, ascending
    const std::vector<std::uint32_t>& cell_of;  // of each fused cell, in the grid
    const std::vector<float>& sigma;            // of each fused cell, metres

    // The first of `which` whose cell has such an x, or a higher one.
    std::size_t first_at(std::int32_t x) const {
        const auto below = [&](std::uint32_t i) { return grid.x[cell_of[i]] < x; };
        return static_cast<std::size_t>(std::ranges::partition_point(which, below) - which.begin());
    }
};

// Moves the cells whose level's cells have x of [low, high) onto the planes fitted there. A plane
// is fitted at the mean of a level's cell and serves all that it was made from: that mean lies
// nearer the surface than its outer layers do, and there are far fewer.
void flatten_slab(FusedCells& fused, const FlattenedLevel& level, std::int32_t low,
                  std::int32_t high, device::Device& device, ThreadPool& pool) {
    // What planes around a cell say counts, too (PlaneFitter::mean_offsets).
    const std::size_t from = first_cell_at(level.grid, low - 2 * plane_radius),
                      to = first_cell_at(level.grid, high + 2 * plane_radius);
    const CellGrid grid = part_of(level.grid, from, to);
    std::vector<std::uint32_t> query_of(grid.size());
    for (std::size_t k = level.first_at(low - plane_radius),
                     end = level.first_at(high + plane_radius);
         k < end; ++k)
        query_of[level.cell_of[level.which[k]] - from] = 1;
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
    const std::size_t first = level.first_at(low);
    pool.each(level.first_at(high) - first, fused_chunk, [&](std::size_t k) {
        const std::uint32_t i = level.which[first + k];
        if (first + k + cells_ahead < level.which.size())
            __builtin_prefetch(fused.cells[level.which[first + k + cells_ahead]]);
        CellSums& cell = *fused.cells[i];
        const std::size_t home = level.cell_of[i] - from;
        const std::uint32_t q = query_of[home];
        const std::array<std::int32_t, 3> index{grid.x[home], grid.y[home], grid.z[home]};
        const std::array<double, 3> at = mean_of(cell);
        double offset = offsets[q];  // from the cell to the surface, cells of the level
        for (std::size_t a = 0; a < 3; ++a) {
            const double from_query = (at[a] - static_cast<double>(key_bias)) / level.scale -
                                      (index[a] + 0.5 + double{grid.mean[a][home]});
            offset -= double{fit.normal[a][q]} * from_query;
        }
        const double noise = level.sigma[i] / grid.cell_m;
        // An edge or a small thing is rougher than the readings' noise, and stays.
        if (fit.rms[q] > 1.5 * noise + 0.1 || std::abs(offset) > 3 * noise + 0.1) return;
        std::array<double, 3> moved = at;
        for (std::size_t a = 0; a < 3; ++a)
            moved[a] += double{fit.normal[a][q]} * offset * level.scale;
        move_to(cell, moved);
    });
}

void flatten_level(FusedCells& fused, const FlattenedLevel& level, device::Device& device,
                   ThreadPool& pool) {
    for (std::size_t k = 0; k < level.which.size();) {
        const std::int32_t low = level.grid.x[level.cell_of[level.which[k]]];
        const std::int32_t high = end_of_slab(level.grid, first_cell_at(level.grid, low));
        flatten_slab(fused, level, low, high, device, pool);
        k = level.first_at(high);
    }
}

// Sorts the cells by key and sums up those of one key.
void bin_anew(FusedCells& fused, ThreadPool& pool) {
    CellTables tables;
    constexpr std::size_t most_parts = 64;
    std::vector<std::span<CellSums* const>> parts;
    const std::span<CellSums* const> cells(fused.cells.data(), fused.cells.size());
    const std::size_t part = std::max(fused_chunk, cells.size() / most_parts + 1);
    for (std::size_t first = 0; first < cells.size(); first += part)
        parts.push_back(cells.subspan(first, std::min(part, cells.size() - first)));
    tables.add(parts, pool);
    fused = FusedCells(std::move(tables), fused.cell_m, pool);
}

// Whether there were any to move; their keys are no longer sorted then.
bool move_to_planes(FusedCells& fused, double least_sigma_m, ThreadPool& pool) {
    const std::size_t n = fused.cells.size();
    std::vector<float> sigma(n);  // of the readings in and around each cell, metres
    std::vector<std::uint8_t> level_of(n);
    visit_surroundings(fused.cells, pool, [&](std::size_t i, const Around& around) {
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
    if (left == 0) return false;
    const std::unique_ptr<device::Device> device = device::open_native(pool.threads());
    CellGrid grid = grid_of(fused, pool);
    std::vector<std::uint32_t> cell_of(n);  // the level's cell of each cell
    std::iota(cell_of.begin(), cell_of.end(), 0u);
    for (std::size_t level = 0; left > 0; ++level) {
        if (level > 0) {
            std::vector<std::uint32_t> parent;
            grid = coarsen_by_slabs(grid, pool, parent);
            pool.each(n, fused_chunk, [&](std::size_t i) { cell_of[i] = parent[cell_of[i]]; });
        }
        if (which[level].empty()) continue;
        flatten_level(fused, {grid, static_cast<double>(1 << level), which[level], cell_of, sigma},
                      *device, pool);
        left -= which[level].size();
    }
    return true;
}

}  // namespace

void flatten_layers(FusedCells& fused, double least_sigma_m, ThreadPool& pool) {
    if (move_to_planes(fused, least_sigma_m, pool)) bin_anew(fused, pool);
}

}  // namespace topple::geometry
