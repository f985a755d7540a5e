// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"
#include "topple/input.h"
#include "vdb/voxel_scene.h"

// Visibility carving (paper, 2.2.2) voxel by voxel and frame by frame, in double precision,
// straight from the depth images: no hierarchy, no packing, no folded matrices. Of the kernels
// carve and carve_leaves.
namespace topple::oracle {

// Of a reading: base + growth * max(depth - from, 0)^2, metres, so many times.
struct CarveNoise {
    double base_m = 0.0012, growth_per_m = 0.0019, from_m = 0.4, sigmas = 2;
};

struct CarveVerdict {
    enum Kind { nothing, through, hit } kind = nothing;
    bool close =
        false;  // so near to a threshold or a pixel's border that single precision may differ
};

inline CarveVerdict carve_voxel(const vdb::VoxelFrame& grid, const Intrinsics& k,
                                const DepthFrame& frame, const CarveNoise& noise,
                                const std::array<std::int32_t, 3>& voxel) {
    CarveVerdict verdict;
    double world[3] = {0, 0, 0};
    for (int d = 0; d < 3; ++d) {
        for (int a = 0; a < 3; ++a)
            world[d] += grid.grid_from_input[a][d] * (voxel[a] + 0.5) * grid.voxel_m;
    }
    double camera[3] = {0, 0, 0};
    for (int a = 0; a < 3; ++a) {
        for (int d = 0; d < 3; ++d) {
            camera[a] +=
                frame.camera_to_world[4 * d + a] * (world[d] - frame.camera_to_world[4 * d + 3]);
        }
    }
    const double z = camera[2];
    const auto near = [](double a, double b, double tolerance) {
        return std::abs(a - b) <= tolerance;
    };
    verdict.close = near(z, 0.02, 1e-5);
    if (z < 0.02) return verdict;
    const double u = k.fx * camera[0] / z + k.cx, v = k.fy * camera[1] / z + k.cy;
    const double pixel_tolerance = 1e-5 * (k.width + k.height + std::abs(u) + std::abs(v));
    verdict.close = verdict.close || near(u, std::round(u), pixel_tolerance) ||
                    near(v, std::round(v), pixel_tolerance);
    if (u < 0 || v < 0 || u >= k.width - 1 || v >= k.height - 1) return verdict;
    const auto x = static_cast<std::size_t>(u), y = static_cast<std::size_t>(v);
    double low = 1e30, high = 0;
    for (std::size_t pixel :
         {y * k.width + x, y * k.width + x + 1, (y + 1) * k.width + x, (y + 1) * k.width + x + 1}) {
        low = std::min(low, frame.depth[pixel] / k.depth_scale);
        high = std::max(high, frame.depth[pixel] / k.depth_scale);
    }
    if (low == 0) return verdict;
    const auto margin = [&](double depth) {
        const double far = std::max(depth - noise.from_m, 0.0);
        return grid.voxel_m * std::sqrt(3.0) / 2 + 0.5 / k.depth_scale +
               noise.sigmas * (noise.base_m + noise.growth_per_m * far * far);
    };
    verdict.close = verdict.close || near(z, low - margin(low), 1e-5 * low) ||
                    near(z, high + margin(high), 1e-5 * high);
    if (z < low - margin(low)) {
        verdict.kind = CarveVerdict::through;
    } else if (z <= high + margin(high)) {
        verdict.kind = CarveVerdict::hit;
    }
    return verdict;
}

}  // namespace topple::oracle
