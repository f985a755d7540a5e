// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "device/device.h"
#include "geometry/cell_grid.h"

namespace topple::geometry {

// Points to fit a plane at: each in its cell of a grid, positions in cells from the cell's centre.
struct PlaneQueries {
    std::vector<std::uint32_t> cell;
    std::array<std::vector<float>, 3> at;
};

// The planes found, one per query.
struct PlaneFit {
    std::array<std::vector<float>, 3> normal;  // unit, sign arbitrary; 0 where undefined
    std::vector<float> rms;                    // of the neighbourhood about the plane, cells
    std::vector<float> offset;  // from the query to the plane along the normal, cells
    std::vector<float> used;    // cells that took part
};

struct PlaneFitOptions {
    int radius = 2;  // of the neighbourhood, cells per axis, 1 to 3
    // Oriented normals of the grid's cells from an earlier fit, or empty: see kernel voxel_normals.
    std::span<const float> prior_x, prior_y, prior_z;
};

// A query at the mean of each cell.
PlaneQueries queries_at_means(const CellGrid& grid);

// Runs kernel voxel_normals, in tiles where the grid is larger than a binding may be.
// Throws Error(device) where not even one layer of cells fits a binding.
PlaneFit fit_planes(device::Device& device, const CellGrid& grid, const PlaneQueries& queries,
                    const PlaneFitOptions& options);

}  // namespace topple::geometry
