// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/surface_samples.h"

namespace topple::geometry {

// What is seen of one primitive, measured on its samples. Metres, z up.
struct PrimitiveShape {
    std::size_t first = 0, last = 0;  // its samples
    double area_m2 = 0;               // of the cells that it has samples in
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    // Standard deviations of its samples along its principal axes, rising, and the axes as columns.
    Eigen::Vector3d spread = Eigen::Vector3d::Zero();
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    // Mean of its normals; its length is 1 for a plane of which one side was seen.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    // Bounds along x, y, z, without the outermost hundredth at either side.
    Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
    // Mean and spread of its colours in L*a*b*; NaN where none are known.
    Eigen::Vector3d colour = Eigen::Vector3d::Constant(NAN);
    double colour_spread = NAN;
    double up_share = 0, down_share = 0, side_share = 0;  // of its normals, within 37 degrees

    std::size_t samples() const { return last - first; }
    // Of the plane through it: the mean normal of what is flat, else the axis of least spread.
    Eigen::Vector3d face() const;
};

struct PrimitiveShapes {
    std::vector<PrimitiveShape> of;  // by primitive; those without samples have no area
    // Of the whole scene, without the outermost hundredth at either side.
    Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
    double area_m2 = 0;
};

PrimitiveShapes primitive_shapes(const SurfaceSamples& samples, std::size_t primitives);

}  // namespace topple::geometry
