// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "topple/input.h"

// Arithmetic of vectors.
namespace topple {

inline double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 plus(const Vec3& a, const Vec3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 opposite(const Vec3& a) {
    return {-a[0], -a[1], -a[2]};
}
// t along b from a.
inline Vec3 along(const Vec3& a, double t, const Vec3& b) {
    return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}
inline double length(const Vec3& v) {
    return std::sqrt(dot(v, v));
}
// Of no direction: as it is.
inline Vec3 unit(Vec3 v) {
    const double l = length(v);
    if (l > 0)
        for (double& x : v) x /= l;
    return v;
}
// Zero where v is no longer than what rounding leaves of unit vectors that cancel.
inline Vec3 unit_or_zero(const Vec3& v) {
    return length(v) > 1e-12 ? unit(v) : Vec3{};
}

}  // namespace topple
