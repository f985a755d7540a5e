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
    for (std::size_t i = 0; i < fit.rms.size(); ++i) {
        if (fit.normal[0][i] != 0 || fit.normal[1][i] != 0 || fit.normal[2][i] != 0)
            rms.push_back(fit.rms[i]);
    }
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
    const std::array<const std::vector<std::int32_t>*, 3> index{&grid.x, &grid.y, &grid.z};
    std::atomic<bool> any = false;
    threads.each(n, clean_chunk, [&](std::size_t i) {
        const bool flat = fit.rms[i] <= 2.5f * noise && std::abs(fit.offset[i]) <= 3 * noise &&
                          fit.used[i] >= 6 &&
                          (fit.normal[0][i] != 0 || fit.normal[1][i] != 0 || fit.normal[2][i] != 0);
        for (std::size_t a = 0; a < 3; ++a) {
            moved[a][i] = (*index[a])[i] + 0.5 + grid.mean[a][i];
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

    const auto cell = [](double v) { return static_cast<std::int64_t>(std::floor(v)); };
    std::array<std::int64_t, 3> lowest{}, highest{};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto [low, high] = std::minmax_element(moved[a].begin(), moved[a].end());
        lowest[a] = cell(*low);
        highest[a] = cell(*high);
    }
    const CellPacking pack(lowest, highest);
    std::vector<std::uint64_t> keys(n);
    threads.each(n, clean_chunk, [&](std::size_t i) {
        keys[i] = pack(cell(moved[0][i]), cell(moved[1][i]), cell(moved[2][i]));
    });
    threads.poll();
    const KeyGroups cells = group_keys(keys);
    std::vector<std::uint32_t> now(n);
    CellGrid merged;
    merged.cell_m = grid.cell_m;
    merged.resize(cells.size());
    std::vector<float> merged_count(cells.size());
    PlaneFit planes;
    for (auto* field : {&planes.normal[0], &planes.normal[1], &planes.normal[2], &planes.rms,
                        &planes.offset, &planes.used})
        field->resize(cells.size());
    threads.each(cells.size(), clean_chunk, [&](std::size_t to) {
        const auto group = cells.group(to);
        std::array<double, 3> at{}, first{};
        for (std::size_t a = 0; a < 3; ++a) at[a] = std::floor(moved[a][group[0]]);
        std::array<double, 6> second{};
        double sum = 0;
        std::uint32_t heaviest = group[0];
        for (const std::uint32_t i : group) {
            if (count[i] > count[heaviest]) heaviest = i;
            now[i] = static_cast<std::uint32_t>(to);
            const double w = count[i];
            std::array<double, 3> d{};
            for (std::size_t a = 0; a < 3; ++a) {
                d[a] = moved[a][i] - at[a] - 0.5;
                first[a] += w * d[a];
            }
            const std::array<double, 6> dd{d[0] * d[0], d[1] * d[1], d[2] * d[2],
                                           d[0] * d[1], d[0] * d[2], d[1] * d[2]};
            for (std::size_t a = 0; a < 6; ++a) second[a] += w * (dd[a] + spread[i][a]);
            sum += w;
        }
        for (double& v : first) v /= sum;
        merged.x[to] = static_cast<std::int32_t>(at[0]);
        merged.y[to] = static_cast<std::int32_t>(at[1]);
        merged.z[to] = static_cast<std::int32_t>(at[2]);
        const std::array<double, 6> mm{first[0] * first[0], first[1] * first[1],
                                       first[2] * first[2], first[0] * first[1],
                                       first[0] * first[2], first[1] * first[2]};
        for (std::size_t a = 0; a < 3; ++a) merged.mean[a][to] = static_cast<float>(first[a]);
        for (std::size_t a = 0; a < 6; ++a) {
            merged.spread[a][to] = static_cast<float>(second[a] / sum - mm[a]);
        }
        merged_count[to] = static_cast<float>(sum);
        for (std::size_t a = 0; a < 3; ++a) planes.normal[a][to] = fit.normal[a][heaviest];
        planes.rms[to] = fit.rms[heaviest];
        planes.used[to] = fit.used[heaviest];
        planes.offset[to] = 0;
        merged.weight[to] = fit_weight(sum);
    });
    grid = std::move(merged);
    count = std::move(merged_count);
    for (std::uint32_t& point : of_point) point = now[point];
    return planes;
}

}  // namespace topple::geometry
