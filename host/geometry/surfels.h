// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "topple/cloud_view.h"
#include "topple/kernels/device.h"

namespace topple::geometry {

// The cloud resampled to one oriented surface element per occupied cell of a cubic grid, or two
// where a cell holds both sides of a thin wall (part_sides()): the working resolution of everything
// up to the primitives. Input frame, metres, one array per field. Surfels are sorted by cell (x,
// then y, then z), so their order does not depend on the order of the points.
struct Surfels {
    double cell_m = 0;
    double area_m2 = 0;                    // surface that a surfel stands for
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
    // CSR over surfels, size()+1, ascending: see connect_surfels().
    std::vector<std::uint32_t> neighbour_first, neighbours;

    std::size_t size() const { return x.size(); }
    // The neighbours of one.
    std::span<const std::uint32_t> around(std::size_t i) const {
        return std::span(neighbours)
            .subspan(neighbour_first[i], neighbour_first[i + 1] - neighbour_first[i]);
    }
    bool has_normal(std::size_t i) const { return nx[i] != 0 || ny[i] != 0 || nz[i] != 0; }
};

// The size of surfels.
struct SurfelScale {
    double cell_m;       // edge of a cell
    double pitch_m = 0;  // distance of neighbouring points, which may be more than a cell
    double reach_m = 0;  // distance of neighbouring surfels at most; 0: adjacent cells alone
    SurfelScale(double cell, double pitch = 0, double reach = 0)
        : cell_m(cell), pitch_m(pitch), reach_m(reach) {}
};

// Resamples the cloud and estimates normals (kernel voxel_normals). `towards` tells for each point
// where its sensor was: one viewpoint per point as an index into `viewpoints`; where the span is
// empty, all points use viewpoint 0; where there are no viewpoints, stored normals orient, and else
// the sign is arbitrary but consistent over smooth neighbourhoods.
Surfels make_surfels(device::Device& device, const CloudView& cloud, const SurfelScale& scale,
                     std::span<const Vec3> viewpoints,
                     std::span<const std::uint32_t> viewpoint_of_point);

// Distances between the points of a cloud, metres; 0 where there are fewer than two places. The
// points' order and repetitions play no part.
struct PointSpacing {
    // Typical distance of a point to its nearest neighbour: the median over a sample of places, but
    // no less than what joins three quarters of the surface, where most points lie on little of it.
    double nearest_m = 0;
    // Distance to the fourth place around a point, about the side of the square of surface that a
    // point stands for: the median over the points, and what three quarters of the surface have at
    // most. Neighbours that a grid of the scanner's put close to one another do not shrink it.
    double around_m = 0, surface_m = 0;
};
PointSpacing point_spacing(const CloudView& cloud);

// Surfels of a cloud that would have cells of `coarse_m`: those are kept where they are finer than
// what things in rooms are thick; coarser ones become as fine as that, or as the points.
SurfelScale surfels_for(const PointSpacing& spacing, double coarse_m);

}  // namespace topple::geometry
