// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/segmentation.h"

// The steps of split() (paper, 2.1.1): regions grow from smooth seeds, first as planes, then, where
// the surface goes on smoothly past its plane, as quadrics; what no region took is handed out
// after.
namespace topple::geometry {

// Bounds of how far a surfel's normal may be off its model's, degrees; between them the scan's own
// noise decides. The one is for clean scans; the other stays well below the 45 degrees by which
// surfels on a box's edge are off both of its faces. Set by hand.
inline constexpr double least_angle_deg = 18, most_angle_deg = 35;

// What the thresholds are measured in; from the surfels themselves.
struct SplitScale {
    std::vector<float> tolerance_m;  // of each surfel: how far off its model it may lie
    double angle_rad = 0;            // how far its normal may be off, at most
    // Of the three-layer fit: one cell, as far as a surfel's neighbours are.
    double layer_m = 0;
};

// Noise of each surfel: the roughness of the smoothest surfels around it, bounded by the scan's own
// distribution so that an edge or a thin rod is not taken for noise.
SplitScale measure_scale(const Surfels& surfels, ThreadPool& threads);

// Grows regions from seeds by rising roughness (ties by index); polls `threads`, but works alone.
Regions grow_regions(const Surfels& surfels, const SplitScale& scale, ThreadPool& threads);

// Gives surfels without a region to the neighbouring region that explains them best, makes regions
// of connected leftovers, lets neighbours take regions that they explain, smooths the borders.
void clean_regions(const Surfels& surfels, const SplitScale& scale, ThreadPool& threads,
                   Regions& regions);

// A region of these surfels (at least one), with a model of degree 1 or 2. layer_m: see
// fit_plane(), fit_quadric().
Region fit_region(const Surfels& surfels, const std::vector<std::uint32_t>& members, int degree,
                  double layer_m);

// Refits every region to its surfels (degree kept, residual and count set); drops empty regions and
// renumbers by lowest surfel.
void refit_regions(const Surfels& surfels, const SplitScale& scale, ThreadPool& threads,
                   Regions& regions);

inline Eigen::Vector3d position(const Surfels& s, std::size_t i) {
    return {s.x[i], s.y[i], s.z[i]};
}
inline Eigen::Vector3d normal(const Surfels& s, std::size_t i) {
    return {s.nx[i], s.ny[i], s.nz[i]};
}

}  // namespace topple::geometry
