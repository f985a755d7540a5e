// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "device/device.h"
#include "topple/cloud_view.h"

namespace topple::geometry {

// The cloud resampled to one oriented surface element per occupied cell of a cubic grid: the
// working resolution of everything up to the primitives. Input frame, metres, one array per field.
// Surfels are sorted by cell (x, then y, then z), so their order does not depend on the order of
// the points.
struct Surfels {
    double cell_m = 0;
    std::vector<std::int32_t> cx, cy, cz;  // cell indices: floor(p / cell_m) per axis
    std::vector<float> x, y, z;            // mean of the cell's points
    std::vector<float> nx, ny, nz;   // unit normal towards the sensor's side; 0 where undefined
    std::vector<float> roughness_m;  // rms distance of the neighbourhood from its plane
    std::vector<float> weight;       // points in the cell
    // CIE L*a*b* under D65 (core/colour_space.h) of the mean of its points' sRGB values: L* from 0
    // to 100, a* and b* about -110 to 100. NaN where no point of the surfel has a known colour; all
    // three are empty where the cloud has no colours.
    std::vector<float> lab_l, lab_a, lab_b;
    std::vector<std::uint32_t> of_point;  // surfel of each point of the cloud
    std::vector<std::uint32_t>
        neighbour_first;                    // CSR over surfels, size()+1: the occupied cells of
    std::vector<std::uint32_t> neighbours;  // the 26 around each, ascending

    std::size_t size() const { return x.size(); }
};

// Resamples the cloud and estimates normals (kernel voxel_normals). `towards` tells for each point
// where its sensor was: one viewpoint per point as an index into `viewpoints`; where the span is
// empty, all points use viewpoint 0; where there are no viewpoints, stored normals orient, and else
// the sign is arbitrary but consistent over smooth neighbourhoods.
Surfels make_surfels(device::Device& device, const CloudView& cloud, double cell_m,
                     std::span<const Vec3> viewpoints,
                     std::span<const std::uint32_t> viewpoint_of_point);

// Typical distance of a point to its nearest neighbour, metres: the median over a sample of places,
// but no less than what joins three quarters of the surface, where most points lie on little of it.
// 0 where there are fewer than two places. The points' order and repetitions play no part.
double point_spacing(const CloudView& cloud);

}  // namespace topple::geometry
