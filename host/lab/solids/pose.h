// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "lab/solids/part.h"

namespace topple::scenes {

// Where something stands: the place of its origin, and its turn about z.
struct Pose {
    double x = 0, y = 0, z = 0, yaw = 0;
};

inline Vec3 moved(const Pose& pose, const Vec3& p) {
    const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
    return {pose.x + c * p[0] - s * p[1], pose.y + s * p[0] + c * p[1], pose.z + p[2]};
}

inline Part moved(const Pose& pose, Part part) {
    part.center = moved(pose, part.center);
    part.yaw += pose.yaw;
    return part;
}

inline Pose moved(const Pose& pose, const Pose& inner) {
    const Vec3 p = moved(pose, Vec3{inner.x, inner.y, inner.z});
    return {p[0], p[1], p[2], pose.yaw + inner.yaw};
}

}  // namespace topple::scenes
