// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "core/vectors.h"

namespace topple {

using Rotation = std::array<Vec3, 3>;  // rows

// That of a transform.
inline Rotation rotation_of(const Mat4& m) {
    return {Vec3{m[0], m[1], m[2]}, Vec3{m[4], m[5], m[6]}, Vec3{m[8], m[9], m[10]}};
}
inline Vec3 turned(const Rotation& r, const Vec3& v) {
    return {dot(r[0], v), dot(r[1], v), dot(r[2], v)};
}
inline Vec3 turned_back(const Rotation& r, const Vec3& v) {
    return along(along(along({}, v[0], r[0]), v[1], r[1]), v[2], r[2]);
}

// By a rigid transform.
inline Vec3 transformed(const Mat4& m, const Vec3& v) {
    return plus(turned(rotation_of(m), v), {m[3], m[7], m[11]});
}

}  // namespace topple
