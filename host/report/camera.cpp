// SPDX-License-Identifier: MIT
#include "report/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/vectors.h"

namespace topple::report {
std::array<double, 3> Camera::project(const Vec3& p) const {
    const Vec3 d = along(p, -1, eye);
    const double depth = dot(d, ahead);
    return {x0 + focal * dot(d, right) / depth, y0 - focal * dot(d, up) / depth, depth};
}

Camera camera_on(const Extents<double>& box, int width, int height,
                 const std::array<double, 4>& margin) {
    Camera camera;
    constexpr Vec3 ahead{0.55, 0.75, -0.62};
    const double level = std::hypot(ahead[0], ahead[1]), length = std::hypot(level, ahead[2]);
    camera.ahead = {ahead[0] / length, ahead[1] / length, ahead[2] / length};
    camera.right = {ahead[1] / level, -ahead[0] / level, 0};
    camera.up = cross(camera.right, camera.ahead);
    camera.focal = height / (2 * std::tan(45 * std::numbers::pi / 360));
    const double wide = width - margin[0] - margin[1], tall = height - margin[2] - margin[3];
    camera.x0 = margin[0] + wide / 2;
    camera.y0 = margin[2] + tall / 2;
    auto corners = box.corners();
    // The nearest upper corner belongs to walls and a ceiling that are looked through.
    corners[4] = corners[0];
    Vec3 target{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        target[axis] = (box.low[axis] + box.high[axis]) / 2;
    const Vec3 size = minus(box.high, box.low);
    const double reach = std::max(std::hypot(size[0], size[1], size[2]), 1e-3);
    double distance = reach;
    for (int round = 0; round < 60; ++round) {
        camera.eye = along(target, -distance, camera.ahead);
        double west = 1e300, east = -1e300, top = 1e300, bottom = -1e300;
        for (const Vec3& corner : corners) {
            const auto [x, y, depth] = camera.project(corner);
            west = std::min(west, x);
            east = std::max(east, x);
            top = std::min(top, y);
            bottom = std::max(bottom, y);
        }
        const double metres = distance / camera.focal;  // of a pixel in the middle
        target = along(target, ((west + east) / 2 - camera.x0) * metres, camera.right);
        target = along(target, (camera.y0 - (top + bottom) / 2) * metres, camera.up);
        distance = std::max(distance * std::max((east - west) / wide, (bottom - top) / tall),
                            0.75 * reach);
    }
    camera.eye = along(target, -distance, camera.ahead);
    return camera;
}

}  // namespace topple::report
