// SPDX-License-Identifier: MIT
#include "geometry/free_space.h"

#include <algorithm>
#include <cmath>

#include "geometry/split.h"

namespace topple::geometry {
namespace {

constexpr double surfels_per_cell = 2.5;  // along an axis
constexpr double most_cells = 64e6;
constexpr std::size_t most_lines = 100'000;
// A line ends this many cells before its surfel: noise, and surfaces that it only grazes.
constexpr double stop_cells = 1.5;
// Lines that must have crossed a cell: one alone may be a stray reading.
constexpr std::uint8_t least_lines = 2;
constexpr std::uint8_t occupied = 255;
// Points on a line between two points that must be free, half a cell apart.
constexpr int least_free = 2;

}  // namespace

FreeSpace::FreeSpace(const Surfels& s, const PointCloud& cloud, std::span<const Vec3> viewpoints,
                     std::span<const std::uint32_t> viewpoint_of_point) {
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
    Eigen::Vector3d high = position(s, 0);
    low_ = high;
    for (std::size_t i = 0; i < s.size(); ++i) {
        low_ = low_.cwiseMin(position(s, i));
        high = high.cwiseMax(position(s, i));
    }
    const Eigen::Vector3d extent = high - low_;
    cell_m_ = surfels_per_cell * s.cell_m;
    const auto cells = [&] {
        double all = 1;
        for (int a = 0; a < 3; ++a) all *= std::floor(extent[a] / cell_m_) + 1;
        return all;
    };
    while (cells() > most_cells) cell_m_ *= 1.25;
    for (int a = 0; a < 3; ++a)
        size_[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(extent[a] / cell_m_) + 1;
    crossed_.assign(static_cast<std::size_t>(cells()), 0);
    for (std::size_t i = 0; i < s.size(); ++i)
        crossed_[static_cast<std::size_t>(index(position(s, i)))] = occupied;
    const std::size_t step = s.size() / most_lines + 1;
    for (std::size_t i = 0; i < s.size(); i += step) {
        const Vec3& eye = viewpoints[seen_from[i]];
        cross({eye[0], eye[1], eye[2]}, position(s, i));
    }
    // A cell beside a surface may reach into the solid behind it.
    for (std::size_t i = 0; i < s.size(); ++i)
        for (int a = 0; a < 3; ++a)
            for (const double side : {-cell_m_, cell_m_}) {
                const std::int64_t at = index(position(s, i) + side * Eigen::Vector3d::Unit(a));
                if (at < 0) continue;
                std::uint8_t& beside = crossed_[static_cast<std::size_t>(at)];
                if (beside != occupied) beside = 0;
            }
}

std::int64_t FreeSpace::index(const Eigen::Vector3d& p) const {
    std::int64_t at = 0;
    for (int a = 0; a < 3; ++a) {
        const double c = std::floor((p[a] - low_[a]) / cell_m_);
        const std::int64_t size = size_[static_cast<std::size_t>(a)];
        if (!(c >= 0 && c < static_cast<double>(size))) return -1;
        at = at * size + static_cast<std::int64_t>(c);
    }
    return at;
}

void FreeSpace::cross(const Eigen::Vector3d& eye, const Eigen::Vector3d& p) {
    const Eigen::Vector3d d = p - eye;
    const double length = d.norm();
    std::vector<std::size_t> cells;
    for (double t = length - stop_cells * cell_m_; t > 0; t -= 0.5 * cell_m_) {
        const std::int64_t at = index(eye + t / length * d);
        if (at < 0) continue;
        const auto cell = static_cast<std::size_t>(at);
        if (crossed_[cell] == occupied) return;
        if (cells.empty() || cells.back() != cell) cells.push_back(cell);
    }
    for (const std::size_t cell : cells) crossed_[cell] += crossed_[cell] < least_lines;
}

bool FreeSpace::at(const Eigen::Vector3d& p) const {
    const std::int64_t i = known() ? index(p) : -1;
    return i >= 0 && crossed_[static_cast<std::size_t>(i)] == least_lines;
}

bool FreeSpace::between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    if (!known()) return false;
    const Eigen::Vector3d d = b - a;
    const double steps = std::ceil(2 * d.norm() / cell_m_);
    int free = 0;
    for (double k = 1; k < steps; ++k) {
        free += at(a + k / steps * d);
        if (free >= least_free) return true;
    }
    return false;
}

}  // namespace topple::geometry
