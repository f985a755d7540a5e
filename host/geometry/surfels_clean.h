// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "device/device.h"
#include "geometry/cell_grid.h"
#include "geometry/plane_fit.h"

namespace topple::geometry {

// Weight of a cell of `count` points in a plane fit. A cell's mean has the variance
// noise^2 / count + (what no plane explains)^2: many points soon stop helping.
inline float fit_weight(double count) {
    return static_cast<float>(count / (count + 4.0));
}

// Moves each cell's mean onto the plane of its neighbourhood and bins anew, so that a surface whose
// noise is thicker than a cell becomes one layer of cells (moving least squares, one step). Only
// where a plane fits as well as it does in most of the scene, and by no more than noise explains:
// edges and small things stay. count: points per cell; of_point: cell of each point; both follow
// the new cells. Returns the planes that were fitted, of each new cell that of its heaviest part.
PlaneFit flatten_noise(device::Device& device, CellGrid& grid, std::vector<float>& count,
                       std::vector<std::uint32_t>& of_point);

}  // namespace topple::geometry
