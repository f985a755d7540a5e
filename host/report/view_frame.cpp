// SPDX-License-Identifier: MIT
#include "report/view_frame.h"

#include <algorithm>
#include <cmath>

#include "core/vectors.h"

namespace topple::report {
namespace {

using Rows = std::array<Vec3, 3>;

Rows rows_of(const Mat4& m) {
    return {Vec3{m[0], m[1], m[2]}, Vec3{m[4], m[5], m[6]}, Vec3{m[8], m[9], m[10]}};
}

bool is_rotation(const Rows& r) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = i; k < 3; ++k) {
            if (!(std::abs(dot(r[i], r[k]) - (i == k ? 1.0 : 0.0)) < 1e-3)) return false;
        }
    }
    return dot(cross(r[0], r[1]), r[2]) > 0;
}

}  // namespace

Rows view_frame(const Scene& scene) {
    const double length = std::sqrt(dot(scene.up, scene.up));
    const Vec3 up = length > 1e-9
                        ? Vec3{scene.up[0] / length, scene.up[1] / length, scene.up[2] / length}
                        : Vec3{0, 0, 1};
    const auto given = rows_of(scene.manhattan_from_input);
    if (is_rotation(given) && dot(given[2], up) > 0.9) return given;
    // The input axis that is farthest from up becomes x.
    std::size_t least = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
        if (std::abs(up[axis]) < std::abs(up[least])) least = axis;
    }
    Vec3 x{};
    x[least] = 1;
    const double along = dot(x, up);
    for (std::size_t axis = 0; axis < 3; ++axis) x[axis] -= along * up[axis];
    const double norm = std::sqrt(dot(x, x));
    for (auto& value : x) value /= norm;
    return {x, cross(up, x), up};
}

Vec3 turned(const Rows& r, const Vec3& p) {
    return {dot(r[0], p), dot(r[1], p), dot(r[2], p)};
}

Vec3 turned(const Rows& r, double x, double y, double z) {
    return turned(r, Vec3{x, y, z});
}

Vec3 turned_back(const Rows& r, const Vec3& p) {
    Vec3 out{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        out[axis] = r[0][axis] * p[0] + r[1][axis] * p[1] + r[2][axis] * p[2];
    return out;
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
