// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "geometry/segmentation.h"

// The steps of merge_convex() (paper, 2.1.2).
namespace topple::geometry {

struct MergeOptions {
    // Share of a segment's points that must lie inside both models (Eq. 3).
    double delta2 = 0.6;
    // How far the segments' ends are set back from the border into their regions, in cells.
    int set_back_cells = 3;
    // Segments sampled per pair of regions, points per segment.
    std::uint32_t segments = 24, points_per_segment = 8;
    // Least length of the common border, as a multiple of the square root of the smaller region's
    // surfels (a square region's side), counted in adjacent surfel pairs.
    double border_share = 1.0;
    // Largest share of point pairs, one of each side, that see each other in front of themselves.
    double concavity_max = 0.12;
    // Points of each region that stand for it when the merged set's convexity is checked.
    std::uint32_t samples = 48;
    // Opposite faces closer than this are the two sides of one board, metres.
    double board_m = 0.06;
};

// What a region looks like from outside: evenly drawn points moved onto the model, with its
// normals.
struct RegionSamples {
    std::vector<Eigen::Vector3d> points, normals;
    double tolerance_m = 0;  // beyond what noise moves a point
};
std::vector<RegionSamples> sample_regions(const Surfels& surfels, const Regions& regions,
                                          const MergeOptions& options);

// Two regions that touch. a < b; `pairs` are adjacent surfels, the first in a, the second in b.
struct Border {
    std::int32_t a = -1, b = -1;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
};
std::vector<Border> find_borders(const Surfels& surfels, const Regions& regions);

// Share of the points on segments across the border that lie inside both models (Eq. 3).
double inside_share(const Surfels& surfels, const Regions& regions, const Border& border,
                    const std::vector<RegionSamples>& samples, const MergeOptions& options);

// Share of point pairs of two regions of which one lies in front of the other's surface.
double concavity(const RegionSamples& a, const RegionSamples& b);

}  // namespace topple::geometry
