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

struct SplitOptions {
    // Distance a surfel may have from a model, in standard deviations of its noise.
    double tolerance_sigma = 3.0;
    // Share of a cell that counts as noise even where the scan is clean: the resampling's own
    // error.
    double cell_noise_share = 0.1;
    // Bounds of the angle between a surfel's normal and its model's, degrees, and how many times
    // the typical angle between neighbouring normals is allowed between them.
    double angle_min_deg = 18, angle_max_deg = 35, angle_factor = 3.0;
    // Surfels below which a region isn't kept as a seed's result.
    std::uint32_t region_min = 8;
    // A plane whose own surfels turn less than this under a quadric (degrees, 90th percentile) is
    // flat.
    double flat_turn_deg = 9;
    // What a quadric must gain over the plane it grew from, in surfels.
    double quadric_gain = 1.25;
    // Largest rms angle between a quadric and its surfels' normals, as a share of the angle bound.
    double quadric_angle_share = 0.55;
    // Layer distance of the three-layer fit, in cells.
    double layer_cells = 1.0;
};

// What the thresholds are measured in; from the surfels themselves.
struct SplitScale {
    std::vector<float> tolerance_m;  // of each surfel: how far off its model it may lie
    double angle_rad = 0;            // how far its normal may be off
    double layer_m = 0;
};

// Noise of each surfel: the roughness of the smoothest surfels around it, bounded by the scan's own
// distribution so that an edge or a thin rod is not taken for noise.
SplitScale measure_scale(const Surfels& surfels, const SplitOptions& options, ThreadPool& threads);

// Grows regions from seeds by rising roughness (ties by index); polls `threads`, but works alone.
Regions grow_regions(const Surfels& surfels, const SplitScale& scale, const SplitOptions& options,
                     ThreadPool& threads);

// Gives surfels without a region to the neighbouring region that explains them best, makes regions
// of connected leftovers, lets neighbours take regions that they explain, smooths the borders.
void clean_regions(const Surfels& surfels, const SplitScale& scale, const SplitOptions& options,
                   ThreadPool& threads, Regions& regions);

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
