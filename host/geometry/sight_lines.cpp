// SPDX-License-Identifier: MIT
#include "geometry/sight_lines.h"

#include <algorithm>
#include <limits>

namespace topple::geometry {
namespace {

constexpr double finest_m = 0.08;
constexpr std::int64_t most_cells = std::int64_t{1} << 31;

}  // namespace

SightLines::SightLines(const SurfaceSamples& s) {
    if (s.size() == 0) return;
    grid_ = CoarseGrid({s.x, s.y, s.z}, std::max(finest_m, 1.5 * s.spacing_m), 2,
                       static_cast<double>(most_cells));
    occupied_.resize(grid_.size());
    for (std::size_t n = 0; n < s.size(); ++n)
        if (!grid_.is_stray(s.x[n], s.y[n], s.z[n]))
            occupied_[grid_.cell_of({s.x[n], s.y[n], s.z[n]})] = true;
}

double SightLines::met_m(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                         double start_m, double reach_m) const {
    if (occupied_.empty()) return std::numeric_limits<double>::infinity();
    for (double t = start_m; t <= reach_m; t += grid_.cell_m()) {
        const std::int64_t cell = grid_.cell_of(from + t * direction);
        if (cell >= 0 && occupied_[cell]) return t;
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace topple::geometry
