// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"
#include "topple/input.h"
#include "topple/kernel_testing/random.h"

namespace topple::oracle {

// A camera at a random place within `radius` of the origin that looks a random way, and a depth
// image with steps and slopes, half of them with holes.
inline DepthFrame random_frame(test::Random& random, const Intrinsics& k, double radius) {
    DepthFrame frame;
    double q[4], norm = 0;
    for (double& c : q) {
        c = random.uniform(-1, 1);
        norm += c * c;
    }
    for (double& c : q) c /= std::sqrt(norm);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    frame.camera_to_world = {1 - 2 * (y * y + z * z),
                             2 * (x * y - z * w),
                             2 * (x * z + y * w),
                             random.uniform(-radius, radius),
                             2 * (x * y + z * w),
                             1 - 2 * (x * x + z * z),
                             2 * (y * z - x * w),
                             random.uniform(-radius, radius),
                             2 * (x * z - y * w),
                             2 * (y * z + x * w),
                             1 - 2 * (x * x + y * y),
                             random.uniform(-radius, radius),
                             0,
                             0,
                             0,
                             1};
    frame.depth.resize(std::size_t{k.width} * k.height);
    const std::uint32_t base = 200 + random.below(4800), slope = random.below(8),
                        step = random.below(1000);
    const std::uint32_t edge = random.below(k.width);
    const bool holes = random.below(2) == 0;
    for (std::uint32_t v = 0; v < k.height; ++v) {
        for (std::uint32_t u = 0; u < k.width; ++u) {
            std::uint32_t d = base + slope * v + (u > edge ? step : 0) + random.below(4);
            if (holes && random.below(50) == 0) d = 0;
            frame.depth[std::size_t{v} * k.width + u] = static_cast<std::uint16_t>(d);
        }
    }
    return frame;
}

}  // namespace topple::oracle
