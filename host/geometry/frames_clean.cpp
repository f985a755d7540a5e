// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "device/devices.h"
#include "geometry/cell_grid.h"
#include "geometry/depth_noise.h"
#include "geometry/frames_cells.h"
#include "geometry/plane_fit.h"

namespace topple::geometry {
namespace {

constexpr std::array<unsigned, 3> key_shift{42, 21, 0};
constexpr int most_levels = 3;

void indices(const FusedCells& fused, CellGrid& grid) {
    grid.cell_m = fused.cell_m;
    grid.resize(fused.cells.size());
    for (std::size_t i = 0; i < fused.cells.size(); ++i) {
        const auto index = [&](unsigned shift) {
            return static_cast<std::int32_t>(
                static_cast<std::int64_t>(fused.cells[i].key >> shift & 0x1FFFFF) - key_bias);
        };
        grid.x[i] = index(key_shift[0]);
        grid.y[i] = index(key_shift[1]);
        grid.z[i] = index(key_shift[2]);
    }
}

// Standard deviation of the readings in and around each cell, metres.
std::vector<float> noise_around(const FusedCells& fused, const std::vector<std::uint32_t>& first,
                                const std::vector<std::uint32_t>& neighbours) {
    std::vector<float> sigma(fused.cells.size());
    for (std::size_t i = 0; i < sigma.size(); ++i) {
        double count = fused.cells[i].count, weight = static_cast<double>(fused.cells[i].weight);
        for (std::uint32_t k = first[i]; k < first[i + 1]; ++k) {
            count += fused.cells[neighbours[k]].count;
            weight += static_cast<double>(fused.cells[neighbours[k]].weight);
        }
        sigma[i] = static_cast<float>(least_depth_sigma * std::sqrt(65535 * count / weight));
    }
    return sigma;
}

}  // namespace

void drop_weak(FusedCells& fused, std::size_t frames) {
    CellGrid grid;
    indices(fused, grid);
    std::vector<std::uint32_t> first, neighbours;
    cell_neighbours(grid.x, grid.y, grid.z, first, neighbours);
    std::vector<CellSums> kept;
    for (std::size_t i = 0; i < fused.cells.size(); ++i) {
        const CellSums& cell = fused.cells[i];
        double count = 0, weight = 0;
        for (std::uint32_t k = first[i]; k < first[i + 1]; ++k) {
            count += fused.cells[neighbours[k]].count;
            weight += static_cast<double>(fused.cells[neighbours[k]].weight);
        }
        const double around = first[i + 1] - first[i];
        const bool lonely = around == 0 && cell.count == 1 && frames > 1;
        // Below a tenth of its surroundings by readings and by certainty.
        const bool weak = around > 0 && 10.0 * cell.count < count / around &&
                          10.0 * static_cast<double>(cell.weight) < weight / around;
        if (!lonely && !weak) kept.push_back(cell);
    }
    fused.cells = std::move(kept);
}

void flatten_layers(FusedCells& fused) {
    const std::size_t n = fused.cells.size();
    if (n == 0) return;
    CellGrid grid;
    indices(fused, grid);
    std::vector<float> sigma;
    {
        std::vector<std::uint32_t> first, neighbours;
        cell_neighbours(grid.x, grid.y, grid.z, first, neighbours);
        sigma = noise_around(fused, first, neighbours);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const CellSums& cell = fused.cells[i];
        for (std::size_t a = 0; a < 3; ++a) {
            grid.mean[a][i] = static_cast<float>(static_cast<double>(cell.offset[a]) /
                                                     static_cast<double>(cell.weight) / 65536 -
                                                 0.5);
        }
        grid.weight[i] = static_cast<float>(static_cast<double>(cell.weight) / 65535);
    }
    // Readings spread by sigma to both sides; a neighbourhood must be wider than that to see which
    // way the surface runs. Coarser grids give the wider ones.
    const std::unique_ptr<device::Device> device = device::open_native();
    std::array<std::vector<double>, 3> moved;
    for (std::size_t a = 0; a < 3; ++a) {
        const auto& index = a == 0 ? grid.x : a == 1 ? grid.y : grid.z;
        moved[a].resize(n);
        for (std::size_t i = 0; i < n; ++i) moved[a][i] = index[i] + 0.5 + grid.mean[a][i];
    }
    std::vector<std::uint32_t> cell_of(n);
    for (std::size_t i = 0; i < n; ++i) cell_of[i] = static_cast<std::uint32_t>(i);
    CellGrid level_grid = grid;
    for (int level = 0; level <= most_levels; ++level) {
        if (level > 0) {
            std::vector<std::uint32_t> parent;
            level_grid = coarsen(level_grid, parent);
            for (std::uint32_t& cell : cell_of) cell = parent[cell];
        }
        const double reach_m = 2.5 * level_grid.cell_m, scale = level_grid.cell_m / grid.cell_m;
        PlaneQueries queries;
        std::vector<std::uint32_t> which;
        for (std::size_t i = 0; i < n; ++i) {
            const bool fits = 3 * sigma[i] <= reach_m;
            const bool fitted_before = level > 0 && 3 * sigma[i] <= reach_m / 2;
            if (!(fits || level == most_levels) || fitted_before) continue;
            const std::uint32_t cell = cell_of[i];
            which.push_back(static_cast<std::uint32_t>(i));
            queries.cell.push_back(cell);
            queries.at[0].push_back(
                static_cast<float>(moved[0][i] / scale - (level_grid.x[cell] + 0.5)));
            queries.at[1].push_back(
                static_cast<float>(moved[1][i] / scale - (level_grid.y[cell] + 0.5)));
            queries.at[2].push_back(
                static_cast<float>(moved[2][i] / scale - (level_grid.z[cell] + 0.5)));
        }
        const PlaneFit fit = fit_planes(*device, level_grid, queries, {});
        for (std::size_t k = 0; k < which.size(); ++k) {
            const std::uint32_t i = which[k];
            const double noise = sigma[i] / level_grid.cell_m;
            // An edge or a small thing is rougher than the readings' noise, and stays.
            if (fit.rms[k] > 1.5 * noise + 0.1 || std::abs(fit.offset[k]) > 3 * noise + 0.1)
                continue;
            for (std::size_t a = 0; a < 3; ++a) {
                moved[a][i] += double{fit.normal[a][k]} * fit.offset[k] * scale;
            }
        }
    }
    CellTable table;
    for (std::size_t i = 0; i < n; ++i) {
        CellSums cell = fused.cells[i];
        cell.key = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            const double at = moved[a][i] + static_cast<double>(key_bias);
            const double whole = std::floor(at);
            cell.key |= static_cast<std::uint64_t>(whole) << key_shift[a];
            cell.offset[a] = cell.weight * static_cast<std::uint64_t>((at - whole) * 65536);
        }
        table.add(cell);
    }
    fused.cells = table.cells();
    std::sort(fused.cells.begin(), fused.cells.end(),
              [](const CellSums& a, const CellSums& b) { return a.key < b.key; });
}

}  // namespace topple::geometry
