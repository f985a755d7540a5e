// SPDX-License-Identifier: MIT
#pragma once

#include "core/vectors.h"
#include "export/shape.h"
#include "standard.h"

// Corners of round solids.
namespace topple::exports::test {

// Of a prism of so many sides about an axis, around a cylinder as much as within it.
inline std::vector<Vec3> prism(const Vec3& center, const Vec3& axis, double radius_m, double half_m,
                               int sides) {
    const auto frame = frame_around(axis);
    std::vector<Vec3> out;
    const double corner_m = 2 * radius_m / (1 + std::cos(std::numbers::pi / sides));
    for (const double at : {-half_m, half_m}) {
        for (int n = 0; n < sides; ++n) {
            const double angle = 2 * std::numbers::pi * n / sides;
            Vec3 p = along(center, at, axis);
            p = along(p, corner_m * std::cos(angle), frame[0]);
            out.push_back(along(p, corner_m * std::sin(angle), frame[1]));
        }
    }
    return out;
}

// On a sphere, of so many meridians, the poles too.
inline std::vector<Vec3> ball(const Vec3& center, double radius_m, int meridians) {
    std::vector<Vec3> out{{center[0], center[1], center[2] - radius_m},
                          {center[0], center[1], center[2] + radius_m}};
    for (int row = 1; row < meridians / 2; ++row) {
        const double up = 2 * std::numbers::pi * row / meridians;
        for (int n = 0; n < meridians; ++n) {
            const double round = 2 * std::numbers::pi * n / meridians;
            out.push_back({center[0] + radius_m * std::sin(up) * std::cos(round),
                           center[1] + radius_m * std::sin(up) * std::sin(round),
                           center[2] - radius_m * std::cos(up)});
        }
    }
    return out;
}

}  // namespace topple::exports::test
