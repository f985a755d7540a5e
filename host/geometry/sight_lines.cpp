// SPDX-License-Identifier: MIT
#include "geometry/sight_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene_bounds.h"

namespace topple::geometry {
namespace {

constexpr double finest_m = 0.08;
constexpr std::int64_t most_cells = std::int64_t{1} << 31;

}  // namespace

SightLines::SightLines(const SurfaceSamples& s) : cell_m_(std::max(finest_m, 1.5 * s.spacing_m)) {
    if (s.size() == 0) return;
    // Strays far away would make the cells large.
    const Bounds<float> bounds = scene_bounds<float>({s.x, s.y, s.z}, static_cast<float>(cell_m_));
    low_ = Eigen::Vector3d(bounds.low[0], bounds.low[1], bounds.low[2]);
    const Eigen::Vector3d high(bounds.high[0], bounds.high[1], bounds.high[2]);
    const auto cells = [&] {
        double all = 1;
        for (std::size_t a = 0; a < 3; ++a) {
            const auto axis = static_cast<Eigen::Index>(a);
            size_[a] = static_cast<std::int64_t>((high[axis] - low_[axis]) / cell_m_) + 1;
            all *= static_cast<double>(size_[a]);
        }
        return all;
    };
    while (cells() > static_cast<double>(most_cells)) cell_m_ *= 2;
    cell_.resize(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]));
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (!bounds.contains(s.x[n], s.y[n], s.z[n])) continue;
        const Eigen::Vector3d c = (Eigen::Vector3d(s.x[n], s.y[n], s.z[n]) - low_) / cell_m_;
        const auto at = [&](std::size_t a) {
            return std::min(static_cast<std::int64_t>(c[static_cast<Eigen::Index>(a)]),
                            size_[a] - 1);
        };
        cell_[(at(0) * size_[1] + at(1)) * size_[2] + at(2)] = true;
    }
}

bool SightLines::occupied(const Eigen::Vector3d& p) const {
    std::array<std::int64_t, 3> c{};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        c[a] = static_cast<std::int64_t>(std::floor((p[axis] - low_[axis]) / cell_m_));
        if (c[a] < 0 || c[a] >= size_[a]) return false;
    }
    return cell_[(c[0] * size_[1] + c[1]) * size_[2] + c[2]];
}

double SightLines::met_m(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                         double start_m, double reach_m) const {
    for (double t = start_m; t <= reach_m; t += cell_m_) {
        if (occupied(from + t * direction)) return t;
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace topple::geometry
