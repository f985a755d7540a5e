// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/surface_samples.h"

namespace topple::graph {

// Where the seen surfaces of two primitives come near each other: each sample of the one within
// near_m() of the other counts with the nearest of the other's. Metres, z up.
struct Border {
    std::int32_t a = -1, b = -1;                   // primitives, a < b
    std::uint32_t near_a = 0, near_b = 0;          // samples of each that are near the other
    double gap_least = 0, gap_20 = 0, gap_50 = 0;  // smallest, and the 20th and 50th percentile
    // Over the pairs of samples: how far both bend away from each other, (n - n').d / |d|, its mean
    // and the shares of pairs that are clearly convex or concave; n.n'; the share of pairs that lie
    // in one plane; the distance of each from the plane of the other.
    double convexity = 0, convex_share = 0, concave_share = 0, parallel = 0, flush_share = 0,
           offset = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // mean of unit vectors from a to b
    Eigen::Vector3d center = Eigen::Vector3d::Zero();     // of all pairs
    Eigen::Vector3d spread = Eigen::Vector3d::Zero();     // standard deviations, rising
    double low = 0, high = 0;                             // along z
    double colour = 0;  // mean distance of both in L*a*b*; NaN where no colours are known
};

// Within which distance surfaces are near: what noise and missing edges leave open, but no less
// than a few samples.
double near_m(double spacing_m);

// Sorted by (a, b).
std::vector<Border> find_borders(const geometry::SurfaceSamples& samples, ThreadPool& threads);

}  // namespace topple::graph
