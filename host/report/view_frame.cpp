// SPDX-License-Identifier: MIT
#include "report/view_frame.h"

#include <algorithm>
#include <cmath>

#include "core/vectors.h"

namespace topple::report {
namespace {

using Rows = std::array<Vec3, 3>;

bool is_rotation(const Rows& r) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = i; k < 3; ++k) {
            if (!(std::abs(dot(r[i], r[k]) - (i == k ? 1.0 : 0.0)) < 1e-3)) return false;
        }
    }
    return dot(cross(r[0], r[1]), r[2]) > 0;
}

}  // namespace

Rows rotation_of(const Mat4& m) {
    return {Vec3{m[0], m[1], m[2]}, Vec3{m[4], m[5], m[6]}, Vec3{m[8], m[9], m[10]}};
}

Rows view_frame(const Scene& scene) {
    const Vec3 up = length(scene.up) > 1e-9 ? topple::unit(scene.up) : Vec3{0, 0, 1};
    const auto given = rotation_of(scene.manhattan_from_input);
    if (is_rotation(given) && dot(given[2], up) > 0.9) return given;
    // The input axis that is farthest from up becomes x.
    std::size_t least = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
        if (std::abs(up[axis]) < std::abs(up[least])) least = axis;
    }
    Vec3 x{};
    x[least] = 1;
    x = topple::unit(along(x, -dot(x, up), up));
    return {x, cross(up, x), up};
}

Vec3 turned(const Rows& r, const Vec3& p) {
    return {dot(r[0], p), dot(r[1], p), dot(r[2], p)};
}

Vec3 turned(const Rows& r, double x, double y, double z) {
    return turned(r, Vec3{x, y, z});
}

Vec3 turned_back(const Rows& r, const Vec3& p) {
    return along(along(along({}, p[0], r[0]), p[1], r[1]), p[2], r[2]);
}

bool finite(const Vec3& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

void Extent::add(const Vec3& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
    }
}

}  // namespace topple::report
