// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "core/vectors.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// Normals this near to an axis count for it.
inline constexpr double near_degrees = 10;

// The defined normals of a set of surfels with a weight each: about the area that a surfel stands
// for, 0..1, less where its neighbourhood is rougher than most (edges, clutter).
struct WeightedNormals {
    std::vector<float> x, y, z, weight;
    std::vector<std::uint32_t> surfel;
    double total = 0;  // sum of weight
    std::size_t size() const { return x.size(); }
    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};
// At most about `most` of them, evenly over the surfels.
WeightedNormals weigh_normals(const Surfels& surfels, std::size_t most);

// Weight of the normals within `degrees` of +-axis.
double weight_near(const WeightedNormals& normals, const Vec3& axis, double degrees);

// The mean of the normals near +-axis, in windows that narrow from 10 to 4 degrees, each repeated
// until it stands still (iteratively reweighted, biweight). Returns the axis itself where no normal
// is near.
Vec3 refine_axis(const WeightedNormals& normals, const Vec3& axis);

}  // namespace topple::geometry
