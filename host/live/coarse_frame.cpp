// SPDX-License-Identifier: MIT
#include "live/coarse_frame.h"

#include <algorithm>
#include <cmath>

namespace topple::live {

Coarse::Coarse(const Intrinsics& intrinsics)
    : fine_(intrinsics), coarse_(intrinsics), step_(std::max(1u, intrinsics.width / 160)) {
    const double step = step_;
    coarse_.width = fine_.width / step_;
    coarse_.height = std::max(1u, fine_.height / step_);
    for (double* value : {&coarse_.fx, &coarse_.fy, &coarse_.cx, &coarse_.cy}) *value /= step;
}

DepthFrame Coarse::of(const DepthFrame& frame) const {
    DepthFrame out;
    out.camera_to_world = frame.camera_to_world;
    for (std::size_t v = 0; v < coarse_.height; ++v)
        for (std::size_t u = 0; u < coarse_.width; ++u)
            out.depth.push_back(frame.depth[v * step_ * fine_.width + u * step_]);
    return out;
}

bool Coarse::leave_out(const Gone& gone, DepthFrame& frame) const {
    bool any = false;
    for (const GonePixel& pixel : gone) {
        if (!pixel.is_sure()) continue;
        const std::uint32_t u0 = pixel.u * step_, v0 = pixel.v * step_;
        const std::uint32_t last_u = std::min(u0 + step_, fine_.width - 1),
                            last_v = std::min(v0 + step_, fine_.height - 1);
        for (std::uint32_t v = v0 - std::min(v0, step_); v <= last_v; ++v) {
            for (std::uint32_t u = u0 - std::min(u0, step_); u <= last_u; ++u) {
                std::uint16_t& stored = frame.depth[std::size_t{v} * fine_.width + u];
                if (stored == 0 ||
                    std::abs(int{stored} - int{pixel.stored}) > alike_depth_m * fine_.depth_scale)
                    continue;
                stored = 0;
                any = true;
            }
        }
    }
    return any;
}

}  // namespace topple::live
