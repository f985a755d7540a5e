// SPDX-License-Identifier: MIT

#include "geometry/face_limits.h"
#include "geometry/merge.h"
#include "geometry/split.h"

namespace topple::geometry {

namespace {

// How far before the face what covers a gap begins at most, and how far behind it nothing may be,
// cells. Set by hand.
constexpr double gap_cover_cells = 3;

// The surfel among `members` closest to p.
Eigen::Vector3d nearest(const Surfels& s, const std::vector<std::uint32_t>& members,
                        const Eigen::Vector3d& p) {
    Eigen::Vector3d best = p;
    double least = 1e300;
    for (const std::uint32_t i : members) {
        const Eigen::Vector3d q = position(s, i);
        const double d = (q - p).squaredNorm();
        if (d < least) least = d, best = q;
    }
    return best;
}

// Whether the gap from a to b in the face with normal n is covered, and nothing is close behind.
bool closed_gap(const Surfels& s, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                const Eigen::Vector3d& n) {
    const double gap = (b - a).norm(), step = 0.5 * s.cell_m;
    if (gap > widest_face_gap_m + s.cell_m) return false;
    int all = 0, covered = 0, open = 0;
    for (double t = 1.5 * s.cell_m; t < gap - s.cell_m; t += step) {
        const Eigen::Vector3d p = a + t / gap * (b - a);
        ++all;
        bool in_front = false, behind = false;
        for (double h = 0; h <= gap_cover_cells * s.cell_m; h += step) {
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

bool are_face_pieces(const Surfels& surfels, const CutRegions& cuts,
                     const std::vector<RegionSamples>& samples, std::size_t a, std::size_t b) {
    constexpr std::size_t starts = 5;
    if (!coplanar(cuts.regions, samples, a, b, rounding_cells * surfels.cell_m)) return false;
    const bool swap = cuts.members[a].size() > cuts.members[b].size();
    const auto &small = cuts.members[swap ? b : a], &large = cuts.members[swap ? a : b];
    int open = 0;
    for (std::size_t k = 0; k < starts && open < 2; ++k) {
        Eigen::Vector3d p = position(surfels, small[k * (small.size() - 1) / (starts - 1)]), q = p;
        for (int round = 0; round < 3; ++round) {
            q = nearest(surfels, large, p);
            p = nearest(surfels, small, q);
        }
        open += !closed_gap(surfels, p, q, samples[a].normals.front());
    }
    return open < 2;
}

}  // namespace topple::geometry
