// SPDX-License-Identifier: MIT
#include "geometry/free_space.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "geometry/split.h"

namespace topple::geometry {
namespace {

constexpr double surfels_per_cell = 2.5;  // along an axis
constexpr double most_free_cells = 64e6;
constexpr std::size_t most_lines = 100'000;
constexpr std::uint64_t space_chunk = 1 << 14;  // cells or surfels handed to a thread at once
// A line ends this many cells before its surfel: noise, and surfaces that it only grazes.
constexpr double stop_cells = 1.5;
// What is noted of a cell while lines are drawn, in any order: two must have crossed it, for one
// alone may be a stray reading.
constexpr std::uint8_t crossed_once = 1, crossed_twice = 2, occupied = 255;
// And what is known of it in the end.
constexpr std::uint8_t is_free = 1;
// Points on a line between two points that must be free, half a cell apart.
constexpr int least_free = 2;

}  // namespace

FreeSpace::FreeSpace(const Surfels& s, const CloudView& cloud, std::span<const Vec3> viewpoints,
                     std::span<const std::uint32_t> viewpoint_of_point, ThreadPool& threads) {
    if (s.size() == 0 || viewpoints.empty()) return;
    // The lowest viewpoint of each surfel's points, whatever their order.
    std::vector<std::uint32_t> seen_from(s.size(), 0);
    if (!viewpoint_of_point.empty()) {
        seen_from.assign(s.size(), static_cast<std::uint32_t>(viewpoints.size() - 1));
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            std::uint32_t& lowest = seen_from[s.of_point[i]];
            lowest = std::min(lowest, viewpoint_of_point[i]);
        }
    }
    grid_ = CoarseGrid({s.x, s.y, s.z}, surfels_per_cell * s.cell_m, 1.25, most_free_cells);
    cell_.assign(grid_.size(), 0);
    const auto is_stray = [&](std::size_t i) { return grid_.is_stray(s.x[i], s.y[i], s.z[i]); };
    for (std::size_t i = 0; i < s.size(); ++i)
        if (!is_stray(i)) cell_[grid_.cell_of(position(s, i))] = occupied;
    const std::size_t step = s.size() / most_lines + 1;
    threads.each((s.size() + step - 1) / step, 256, [&](std::size_t line) {
        const std::size_t i = line * step;
        if (is_stray(i)) return;
        const Vec3& eye = viewpoints[seen_from[i]];
        cross({eye[0], eye[1], eye[2]}, position(s, i));
    });
    threads.each(cell_.size(), space_chunk, [&](std::size_t n) {
        std::uint8_t& c = cell_[n];
        if (c != occupied) c = (c & crossed_twice) != 0 ? is_free : 0;
    });
    // A cell beside a surface may reach into the solid behind it.
    threads.each(s.size(), space_chunk, [&](std::size_t i) {
        for (int a = 0; a < 3; ++a)
            for (const double side : {-cell_m(), cell_m()}) {
                const std::int64_t at =
                    grid_.cell_of(position(s, i) + side * Eigen::Vector3d::Unit(a));
                if (at < 0) continue;
                const std::atomic_ref beside(cell_[at]);
                if (beside.load(std::memory_order_relaxed) == is_free)
                    beside.store(0, std::memory_order_relaxed);
            }
    });
}

void FreeSpace::cross(const Eigen::Vector3d& eye, const Eigen::Vector3d& p) {
    const Eigen::Vector3d d = p - eye;
    const double length = d.norm();
    const Eigen::Vector3d from = grid_.in_cells(eye), along = d / length / cell_m();
    std::vector<std::size_t> cells;
    for (double t = length - stop_cells * cell_m(); t > 0; t -= 0.5 * cell_m()) {
        const std::int64_t at = grid_.cell_at(from + t * along);
        if (at < 0) continue;
        const auto cell = static_cast<std::size_t>(at);
        if (std::atomic_ref(cell_[cell]).load(std::memory_order_relaxed) == occupied) return;
        if (cells.empty() || cells.back() != cell) cells.push_back(cell);
    }
    for (const std::size_t cell : cells) {
        const std::atomic_ref c(cell_[cell]);
        if ((c.load(std::memory_order_relaxed) & crossed_twice) != 0) continue;
        if ((c.fetch_or(crossed_once, std::memory_order_relaxed) & crossed_once) != 0)
            c.fetch_or(crossed_twice, std::memory_order_relaxed);
    }
}

bool FreeSpace::at(const Eigen::Vector3d& p) const {
    const std::int64_t i = known() ? grid_.cell_of(p) : -1;
    return i >= 0 && cell_[i] == is_free;
}

bool FreeSpace::between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    if (!known()) return false;
    const double steps = std::ceil(2 * (b - a).norm() / cell_m());
    const Eigen::Vector3d from = grid_.in_cells(a), step = (grid_.in_cells(b) - from) / steps;
    int free = 0;
    for (double k = 1; k < steps; ++k) {
        const std::int64_t at = grid_.cell_at(from + k * step);
        free += at >= 0 && cell_[at] == is_free;
        if (free >= least_free) return true;
    }
    return false;
}

}  // namespace topple::geometry
