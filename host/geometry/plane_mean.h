// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/thread_pool.h"
#include "geometry/plane_fit.h"

namespace topple::geometry {

// From each query along its normal to the surface, in cells. The plane that is fitted to a
// neighbourhood of a curved surface lies inside of it by b = mean(r^2) / 2 R, parallel to its
// tangent plane; and r away from there by b - r^2 / 2 R. So what all planes of a neighbourhood say,
// on average by the same weights as they were fitted with, is right to second order, while one
// alone shrinks what is round. queries: one in a cell at most; fit: theirs. Planes that face
// elsewhere don't count.
std::vector<float> mean_offsets(const CellGrid& grid, const PlaneQueries& queries,
                                const PlaneFit& fit, ThreadPool& pool);

}  // namespace topple::geometry
