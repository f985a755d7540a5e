// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "topple/input.h"

// Arithmetic of vectors. For this folder.
namespace topple::physics {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

inline double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vec3 along(const Vec3& a, double t, const Vec3& b) {
    return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}
inline Vec3 opposite(const Vec3& a) {
    return {-a[0], -a[1], -a[2]};
}
inline Vec3 unit(const Vec3& a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

}  // namespace topple::physics
