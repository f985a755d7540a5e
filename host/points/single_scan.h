// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "topple/cloud_view.h"

namespace topple::geometry {

// What is known of a cloud that one sensor took from one place.
struct SingleScan {
    Vec3 eye{};              // where the sensor was, input frame, metres
    double spacing = 0;      // between the directions of neighbouring points, tangent of the angle
    std::optional<Vec3> up;  // the sensor's, by the custom of the axes that it looks along
};

// Whether one sensor at `eye` may have taken the whole cloud, whose points are `spacing_m` apart:
// hardly a point then lies hidden behind others, none lies where the sensor stood, no large surface
// is seen edge-on, and normals, where there are any, face it. Up follows custom: of a limited view
// along z it is -y (cameras), along -z it is y (graphics), along x it is z (robots); a view all
// around tells nothing. Empty where the cloud must be of several views, or is too small to tell.
std::optional<SingleScan> find_single_scan(const CloudView& cloud, const Vec3& eye,
                                           double spacing_m);

}  // namespace topple::geometry
