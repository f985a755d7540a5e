// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "core/extents.h"
#include "topple/input.h"

namespace topple::report {

// A pinhole camera that looks at a scene from above, as the page does at first. Its picture is
// `width` by `height` pixels, x to the right and y downwards.
struct Camera {
    Vec3 eye{}, right{}, up{}, ahead{};
    double focal = 1, x0 = 0, y0 = 0;  // pixels

    // x and y in pixels, and the depth: metres along `ahead`.
    std::array<double, 3> project(const Vec3& p) const;
};

// As near as the box fits into the picture but for a margin, in pixels, on each side: left, right,
// top, bottom.
Camera camera_on(const Extents<double>& box, int width, int height,
                 const std::array<double, 4>& margin);

}  // namespace topple::report
