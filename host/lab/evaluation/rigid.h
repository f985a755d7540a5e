// SPDX-License-Identifier: MIT
#pragma once

#include "topple/input.h"

// Rigid transforms, row-major.
namespace topple::evaluation {

inline Vec3 turned(const Mat4& m, const Vec3& v) {
    return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[4] * v[0] + m[5] * v[1] + m[6] * v[2],
            m[8] * v[0] + m[9] * v[1] + m[10] * v[2]};
}

inline Vec3 moved(const Mat4& m, const Vec3& p) {
    const Vec3 q = turned(m, p);
    return {q[0] + m[3], q[1] + m[7], q[2] + m[11]};
}

inline Vec3 moved_back(const Mat4& m, const Vec3& p) {
    const Vec3 d{p[0] - m[3], p[1] - m[7], p[2] - m[11]};
    return {m[0] * d[0] + m[4] * d[1] + m[8] * d[2], m[1] * d[0] + m[5] * d[1] + m[9] * d[2],
            m[2] * d[0] + m[6] * d[1] + m[10] * d[2]};
}

}  // namespace topple::evaluation
