// SPDX-License-Identifier: MIT
#include "perf/peers/frame_peers.h"

#include <cstdint>

namespace topple::perf {
namespace {

template <typename T>
void write(const ScriptFile& file, const std::vector<T>& values) {
    file.write({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

}  // namespace

std::vector<Told> frame_peers(const Intrinsics& k, std::span<const DepthFrame> frames,
                              double voxel_m) {
    std::vector<double> camera{voxel_m, double(k.width), double(k.height), k.fx, k.fy, k.cx,
                               k.cy,    k.depth_scale};
    std::vector<std::uint16_t> depth;
    for (const DepthFrame& frame : frames) {
        const Mat4& pose = frame.camera_to_world;
        camera.insert(camera.end(), pose.begin(), pose.end());
        depth.insert(depth.end(), frame.depth.begin(), frame.depth.end());
    }
    const ScriptFile cameras("camera.f64"), depths("depth.u16");
    write(cameras, camera);
    write(depths, depth);
    return times_of("frame_peers.py", {&cameras, &depths});
}

}  // namespace topple::perf
