// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "topple/input.h"

// Rigid transforms, row-major.
namespace topple::scenes {

inline constexpr Mat4 identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

inline Vec3 turned(const Mat4& m, const Vec3& v) {
    return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[4] * v[0] + m[5] * v[1] + m[6] * v[2],
            m[8] * v[0] + m[9] * v[1] + m[10] * v[2]};
}

inline Vec3 moved(const Mat4& m, const Vec3& p) {
    const Vec3 q = turned(m, p);
    return {q[0] + m[3], q[1] + m[7], q[2] + m[11]};
}

// By a rotation, then a shift.
inline Mat4 rigid(const std::array<double, 9>& r, const Vec3& t) {
    return {r[0], r[1], r[2], t[0], r[3], r[4], r[5], t[1], r[6], r[7], r[8], t[2], 0, 0, 0, 1};
}

inline Mat4 product(const Mat4& a, const Mat4& b) {
    Mat4 out{};
    for (std::size_t r = 0; r < 4; ++r) {
        for (std::size_t c = 0; c < 4; ++c) {
            for (std::size_t k = 0; k < 4; ++k) out[4 * r + c] += a[4 * r + k] * b[4 * k + c];
        }
    }
    return out;
}

inline Mat4 inverse(const Mat4& m) {
    Mat4 out = rigid({m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]}, {});
    const Vec3 t = moved(out, {m[3], m[7], m[11]});
    out[3] = -t[0];
    out[7] = -t[1];
    out[11] = -t[2];
    return out;
}

}  // namespace topple::scenes
