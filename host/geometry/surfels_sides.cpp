// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "geometry/surfel_steps.h"

namespace topple::geometry {
namespace {

constexpr std::uint64_t sides_chunk = 1 << 14;  // points handed to a thread at once

// How far apart both sides must lie, in standard deviations of either and in cells, and how
// directly their sensors must have looked at the cell's plane, as the mean cosine.
constexpr double least_sigmas = 4, least_cells = 0.1, least_side_cosine = 0.5;

using Axes = std::array<FloatColumn, 3>;

// Whether the point's sensor was behind the plane of its cell.
bool is_behind(const SensorSides& sides, const PlaneFit& planes, std::size_t point,
               std::size_t cell) {
    const std::array<double, 3> way = sides.way(point);
    return way[0] * planes.normal[0][cell] + way[1] * planes.normal[1][cell] +
               way[2] * planes.normal[2][cell] <
           0;
}

// The points of one side of a cell, along the normal of its plane, in cells.
struct CloudSide {
    double mean = 0, variance = 0, cosine = 0;
};

CloudSide side_of(const Axes& cloud, const SensorSides& sides, const PlaneFit& planes,
                  const CellGrid& grid, std::size_t cell, std::span<const std::uint32_t> points) {
    const auto [mean, c] = moments_of(cloud, points, grid.index(cell), grid.cell_m);
    const double x = planes.normal[0][cell], y = planes.normal[1][cell], z = planes.normal[2][cell];
    CloudSide out;
    out.mean = x * mean[0] + y * mean[1] + z * mean[2];
    out.variance = x * x * c[0] + y * y * c[1] + z * z * c[2] +
                   2 * (x * y * c[3] + x * z * c[4] + y * z * c[5]);
    std::array<double, 3> t{};
    for (const std::uint32_t i : points) {
        const std::array<float, 3> one_t = sides.towards(i);
        for (std::size_t a = 0; a < 3; ++a) t[a] += one_t[a];
    }
    out.cosine = (x * t[0] + y * t[1] + z * t[2]) / static_cast<double>(points.size());
    return out;
}

bool apart(const CloudSide& front, const CloudSide& back) {
    const double gap = std::abs(front.mean - back.mean);
    return front.cosine >= least_side_cosine && back.cosine <= -least_side_cosine &&
           gap >= least_cells &&
           gap * gap >= least_sigmas * least_sigmas * std::max(front.variance, back.variance);
}

// A cell's points, first those in front of its plane.
struct Parted {
    std::uint32_t cell;
    std::span<const std::uint32_t> front, back;
};

}  // namespace

void part_sides(const CloudView& cloud, const SensorSides& sides, ThreadPool& threads,
                CellGrid& grid, std::vector<float>& count, std::vector<std::uint32_t>& of_point,
                PlaneFit& planes) {
    if (!sides.known()) return;
    std::vector<std::uint8_t> behind(cloud.size());
    threads.each(cloud.size(), sides_chunk,
                 [&](std::size_t i) { behind[i] = is_behind(sides, planes, i, of_point[i]); });
    std::vector<std::uint8_t> seen_from(grid.size(), 0);  // 1: in front, 2: behind
    for (std::size_t i = 0; i < cloud.size(); ++i)
        seen_from[of_point[i]] |= static_cast<std::uint8_t>(1 << behind[i]);
    std::vector<std::uint32_t> points;
    std::vector<std::uint64_t> keys;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (seen_from[of_point[i]] != 3) continue;
        points.push_back(static_cast<std::uint32_t>(i));
        keys.push_back(2 * std::uint64_t{of_point[i]} + behind[i]);
    }
    KeyGroups groups = group_keys(keys, threads);
    for (std::uint32_t& n : groups.order) n = points[n];
    const Axes axes{cloud.x, cloud.y, cloud.z};
    std::vector<std::uint8_t> is_wall(groups.size() / 2);
    threads.each(is_wall.size(), 64, [&](std::size_t n) {
        const auto front = groups.group(2 * n), back = groups.group(2 * n + 1);
        const std::size_t cell = of_point[front[0]];
        is_wall[n] = apart(side_of(axes, sides, planes, grid, cell, front),
                           side_of(axes, sides, planes, grid, cell, back));
    });
    std::vector<Parted> parted;
    for (std::size_t n = 0; n < is_wall.size(); ++n)
        if (is_wall[n] != 0)
            parted.push_back(
                {of_point[groups.group(2 * n)[0]], groups.group(2 * n), groups.group(2 * n + 1)});
    if (parted.empty()) return;

    // Each of those cells twice.
    std::vector<std::uint32_t> from;
    from.reserve(grid.size() + parted.size());
    std::vector<std::uint32_t> now(grid.size());
    auto next = parted.begin();
    for (std::uint32_t cell = 0; cell < grid.size(); ++cell) {
        now[cell] = static_cast<std::uint32_t>(from.size());
        from.push_back(cell);
        if (next == parted.end() || next->cell != cell) continue;
        from.push_back(cell);
        ++next;
    }
    const auto spread_out = [&](auto& values) {
        auto all = values;
        all.resize(from.size());
        for (std::size_t n = 0; n < from.size(); ++n) all[n] = values[from[n]];
        values = std::move(all);
    };
    for (auto* index : {&grid.x, &grid.y, &grid.z}) spread_out(*index);
    for (auto& values : grid.mean) spread_out(values);
    for (auto& values : grid.spread) spread_out(values);
    for (auto* values : planes.columns()) spread_out(*values);
    for (auto* values : {&grid.weight, &count}) spread_out(*values);
    threads.each(of_point.size(), sides_chunk,
                 [&](std::size_t i) { of_point[i] = now[of_point[i]]; });
    for (const Parted& p : parted) {
        const auto set = [&](std::uint32_t cell, std::span<const std::uint32_t> side) {
            for (const std::uint32_t i : side) of_point[i] = cell;
            grid.set(cell, moments_of(axes, side, grid.index(cell), grid.cell_m));
            count[cell] = static_cast<float>(side.size());
            grid.weight[cell] = fit_weight(static_cast<double>(side.size()));
        };
        set(now[p.cell], p.front);
        set(now[p.cell] + 1, p.back);
    }
}

}  // namespace topple::geometry
