// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/merge.h"

namespace topple::geometry {

namespace {

using Points = std::vector<Eigen::Vector3d>;

std::size_t nearest(const Points& points, const Eigen::Vector3d& p) {
    std::size_t best = 0;
    double least = 1e300;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double d = (points[i] - p).squaredNorm();
        if (d < least) least = d, best = i;
    }
    return best;
}

// Whether the gap from a to b in the face with normal n is covered, and nothing is close behind.
bool closed_gap(const Surfels& s, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                const Eigen::Vector3d& n, const MergeOptions& options) {
    const double gap = (b - a).norm(), step = 0.5 * s.cell_m;
    if (gap > options.gap_m + s.cell_m) return false;
    int all = 0, covered = 0, open = 0;
    for (double t = 1.5 * s.cell_m; t < gap - s.cell_m; t += step) {
        const Eigen::Vector3d p = a + t / gap * (b - a);
        ++all;
        bool in_front = false, behind = false;
        for (double h = 0; h <= options.gap_cover_cells * s.cell_m; h += step) {
            in_front |= surfel_at(s, p + (h + s.cell_m) * n) >= 0;
            const std::int64_t at = surfel_at(s, p - (h + 1.5 * s.cell_m) * n);
            if (at < 0) continue;
            // The far side of a thin board faces away and is no sign of a gap.
            const auto i = static_cast<std::size_t>(at);
            behind |= n.dot(Eigen::Vector3d(s.nx[i], s.ny[i], s.nz[i])) > -0.7;
        }
        covered += in_front;
        open += behind;
    }
    return all > 0 && 2 * covered >= all && 5 * open <= all;
}

}  // namespace

std::vector<std::pair<std::int32_t, std::int32_t>> find_face_pieces(
    const Surfels& surfels, const Regions& regions, const std::vector<RegionSamples>& samples,
    const MergeOptions& options) {
    constexpr std::uint64_t least = 12;  // surfels that a piece must have
    constexpr std::size_t starts = 5;
    const std::size_t count = regions.regions.size();
    std::vector<Points> members(count);
    std::vector<Eigen::AlignedBox3d> box(count);
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        if (regions.label[i] < 0) continue;
        const auto k = static_cast<std::size_t>(regions.label[i]);
        if (regions.regions[k].model.degree == 1 && regions.regions[k].surfels >= least)
            members[k].emplace_back(surfels.x[i], surfels.y[i], surfels.z[i]);
    }
    for (std::size_t k = 0; k < count; ++k)
        for (const auto& p : members[k]) box[k].extend(p);
    // The widest gap that closed_gap() looks into, and a little for rounding.
    const double reach = 1.001 * (options.gap_m + surfels.cell_m);
    std::vector<std::pair<std::int32_t, std::int32_t>> pieces;
    for (std::size_t a = 0; a < count; ++a) {
        if (members[a].empty()) continue;
        for (std::size_t b = a + 1; b < count; ++b) {
            if (members[b].empty() || box[a].exteriorDistance(box[b]) > reach) continue;
            if (!coplanar(regions, samples, a, b, 0.25 * surfels.cell_m)) continue;
            std::size_t open = 0;
            const bool swap = members[a].size() > members[b].size();
            const Points &small = members[swap ? b : a], &large = members[swap ? a : b];
            for (std::size_t k = 0; k < starts && open < 2; ++k) {
                Eigen::Vector3d p = small[k * (small.size() - 1) / (starts - 1)], q = p;
                for (int round = 0; round < 3; ++round) {
                    q = large[nearest(large, p)];
                    p = small[nearest(small, q)];
                }
                open += !closed_gap(surfels, p, q, samples[a].normals.front(), options);
            }
            if (open < 2)
                pieces.emplace_back(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
        }
    }
    return pieces;
}

}  // namespace topple::geometry
