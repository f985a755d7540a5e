// SPDX-License-Identifier: MIT
#pragma once

#include "topple/input.h"

// Arithmetic of vectors. For this folder.
namespace topple::report {

inline double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vec3 plus(const Vec3& a, double share, const Vec3& b) {
    return {a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]};
}

}  // namespace topple::report
