// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

#include "geometry/primitive_shapes.h"
#include "geometry/surface_samples.h"

namespace topple::geometry {

// What is seen about an upright face that tells the front of a cupboard from a wall: seen areas
// over those that would be full, about 0 to 1.
struct FaceSurroundings {
    double floor_behind = 0, floor_before = 0;  // within 1.5 m; a wall has floor at one side
    double top_behind = 0;                      // level, at the height of its upper edge
    double ends_behind = 0;  // upright, going back from its ends: the sides of a cupboard
    double wall_over = 0;    // faces the same way above its upper edge, behind it
};

// out: level unit vector, from the face to where it was seen from. low_m, high_m: the face's ends
// along (-out.y, out.x).
FaceSurroundings face_surroundings(const SurfaceSamples& samples, const PrimitiveShape& face,
                                   double floor_m, const Eigen::Vector3d& out, double low_m,
                                   double high_m);

}  // namespace topple::geometry
