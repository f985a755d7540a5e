// SPDX-License-Identifier: MIT
#include "report/view_frame.h"

#include <cmath>

namespace topple::report {
namespace {

bool is_rotation(const Rotation& r) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = i; k < 3; ++k) {
            if (!(std::abs(dot(r[i], r[k]) - (i == k ? 1.0 : 0.0)) < 1e-3)) return false;
        }
    }
    return dot(cross(r[0], r[1]), r[2]) > 0;
}

}  // namespace

Rotation view_frame(const Scene& scene) {
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

}  // namespace topple::report
