// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "core/ranked.h"
#include "geometry/surfel_steps.h"

namespace topple::geometry {
namespace {

constexpr std::uint64_t clean_chunk = 1 << 14;  // cells handed to a thread at once

// Roughness of most cells: the noise, as long as most of the scene is smooth.
float median_rms(const PlaneFit& fit) {
    std::vector<float> rms;
    for (std::size_t i = 0; i < fit.size(); ++i)
        if (fit.has_plane(i)) rms.push_back(fit.rms[i]);
    return upper_median(rms);
}

// The part of a covariance that lies in the plane with the given normal: P C P, P = I - n n'.
std::array<double, 6> in_plane(const CellGrid& grid, const PlaneFit& fit, std::size_t i) {
    const std::array<double, 3> n{fit.normal[0][i], fit.normal[1][i], fit.normal[2][i]};
    constexpr std::array<std::array<std::size_t, 3>, 3> at{{{0, 3, 4}, {3, 1, 5}, {4, 5, 2}}};
    std::array<double, 3> cn{};
    double ncn = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) cn[a] += grid.spread[at[a][b]][i] * n[b];
        ncn += n[a] * cn[a];
    }
    std::array<double, 6> c{};
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = a; b < 3; ++b) {
            c[at[a][b]] =
                grid.spread[at[a][b]][i] - n[a] * cn[b] - cn[a] * n[b] + ncn * n[a] * n[b];
        }
    }
    return c;
}

}  // namespace

PlaneFit flatten_noise(device::Device& device, CellGrid& grid, std::vector<float>& count,
                       std::vector<std::uint32_t>& of_point) {
    const PlaneFit fit = fit_planes(device, grid, queries_at_means(grid));
    const float noise = median_rms(fit);
    const std::size_t n = grid.size();
    ThreadPool& threads = device.threads();
    // Positions in cells from the grid's origin, and the in-cell covariance, after the move.
    std::array<std::vector<double>, 3> moved;
    for (auto& axis : moved) axis.resize(n);
    std::vector<std::array<double, 6>> spread(n);
    std::atomic<bool> any = false;
    threads.each(n, clean_chunk, [&](std::size_t i) {
        const bool flat = fit.rms[i] <= 2.5f * noise && std::abs(fit.offset[i]) <= 3 * noise &&
                          fit.used[i] >= 6 && fit.has_plane(i);
        for (std::size_t a = 0; a < 3; ++a) {
            moved[a][i] = grid.index(i)[a] + 0.5 + grid.mean[a][i];
            if (flat) moved[a][i] += double{fit.normal[a][i]} * fit.offset[i];
        }
        if (flat) {
            any.store(true, std::memory_order_relaxed);
            spread[i] = in_plane(grid, fit, i);
        } else {
            for (std::size_t a = 0; a < 6; ++a) spread[i][a] = grid.spread[a][i];
        }
    });
    if (!any) return fit;

    const auto cell_of = [&](std::size_t i) {
        GridCell at{};
        for (std::size_t a = 0; a < 3; ++a)
            at[a] = static_cast<std::int64_t>(std::floor(moved[a][i]));
        return at;
    };
    threads.poll();
    const KeyGroups cells = group_cells(n, cell_of, threads);
    std::vector<std::uint32_t> now(n);
    CellGrid merged;
    merged.cell_m = grid.cell_m;
    merged.resize(cells.size());
    std::vector<float> merged_count(cells.size());
    PlaneFit planes;
    planes.resize(cells.size());
    threads.each(cells.size(), clean_chunk, [&](std::size_t to) {
        const auto group = cells.group(to);
        const GridCell at = cell_of(group[0]);
        MomentSums sums;
        std::uint32_t heaviest = group[0];
        for (const std::uint32_t i : group) {
            if (count[i] > count[heaviest]) heaviest = i;
            now[i] = static_cast<std::uint32_t>(to);
            std::array<double, 3> d{};
            for (std::size_t a = 0; a < 3; ++a)
                d[a] = moved[a][i] - static_cast<double>(at[a]) - 0.5;
            sums.add(count[i], d, spread[i]);
        }
        merged.set_index(to, at);
        merged.set(to, sums.moments());
        merged_count[to] = static_cast<float>(sums.weight);
        merged.weight[to] = fit_weight(sums.weight);
        for (std::size_t a = 0; a < 3; ++a) planes.normal[a][to] = fit.normal[a][heaviest];
        planes.rms[to] = fit.rms[heaviest];
        planes.used[to] = fit.used[heaviest];
    });
    grid = std::move(merged);
    count = std::move(merged_count);
    for (std::uint32_t& point : of_point) point = now[point];
    return planes;
}

}  // namespace topple::geometry
