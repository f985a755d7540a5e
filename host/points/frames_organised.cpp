// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "points/frames_fusion.h"

namespace topple::geometry {
namespace {

// Least-squares line pixel = focal * slope + centre.
struct Line {
    double focal = 0, centre = 0, rms = 0;
};

Line fit_line(const std::vector<double>& slope, const std::vector<double>& pixel) {
    const auto n = static_cast<double>(slope.size());
    double ms = 0, mp = 0;
    for (std::size_t i = 0; i < slope.size(); ++i) {
        ms += slope[i] / n;
        mp += pixel[i] / n;
    }
    double ss = 0, sp = 0;
    for (std::size_t i = 0; i < slope.size(); ++i) {
        ss += (slope[i] - ms) * (slope[i] - ms);
        sp += (slope[i] - ms) * (pixel[i] - mp);
    }
    Line line;
    if (!(ss > 1e-12 * n)) return line;
    line.focal = sp / ss;
    line.centre = mp - line.focal * ms;
    double sum = 0;
    for (std::size_t i = 0; i < slope.size(); ++i) {
        const double off = line.focal * slope[i] + line.centre - pixel[i];
        sum += off * off;
    }
    line.rms = std::sqrt(sum / n);
    return line;
}

}  // namespace

bool frame_of_organised_cloud(const CloudView& cloud, Intrinsics& intrinsics, DepthFrame& frame) {
    constexpr std::size_t least_points = 16;
    constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28;
    const std::uint64_t pixels = std::uint64_t{cloud.width} * cloud.height;
    if (cloud.width < 2 || cloud.height < 2 || pixels > most_pixels ||
        cloud.size() < least_points ||
        (cloud.pixel.empty() ? pixels : cloud.pixel.size()) != cloud.size()) {
        return false;
    }
    // The camera stands at the viewpoint and looks along z with y down, or (as graphics has it)
    // along -z with y up: organised clouds are kept in its frame.
    const Vec3 eye = cloud.has_viewpoint ? cloud.viewpoint : Vec3{0, 0, 0};
    std::size_t ahead = 0;
    for (const float z : cloud.z) ahead += z > eye[2];
    const double side = 2 * ahead >= cloud.size() ? 1 : -1;
    std::vector<double> sx, sy, u, v;
    double farthest = 0;
    std::size_t behind = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double z = side * (cloud.z[i] - eye[2]);
        if (!(z > 0) || cloud.pixel_of(i) >= pixels) {
            ++behind;
            continue;
        }
        sx.push_back((cloud.x[i] - eye[0]) / z);
        sy.push_back(side * (cloud.y[i] - eye[1]) / z);
        u.push_back(static_cast<double>(cloud.pixel_of(i) % cloud.width));
        v.push_back(static_cast<double>(cloud.pixel_of(i) / cloud.width));
        farthest = std::max(farthest, z);
    }
    if (sx.size() < least_points || behind > cloud.size() / 100) return false;
    const Line across = fit_line(sx, u), down = fit_line(sy, v);
    if (!(across.focal > 0) || !(down.focal > 0) || across.rms > 1 || down.rms > 1) return false;

    intrinsics.width = cloud.width;
    intrinsics.height = cloud.height;
    intrinsics.fx = across.focal;
    intrinsics.fy = down.focal;
    intrinsics.cx = across.centre;
    intrinsics.cy = down.centre;
    // A tenth of a millimetre where 16 bits reach that far.
    intrinsics.depth_scale = std::min(10000.0, 65535 / farthest);
    if (intrinsics.depth_scale > 1) intrinsics.depth_scale = std::floor(intrinsics.depth_scale);
    frame.depth.assign(pixels, 0);
    frame.camera_to_world = {1, 0, 0, eye[0], 0, side, 0, eye[1], 0, 0, side, eye[2], 0, 0, 0, 1};
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double z = side * (cloud.z[i] - eye[2]);
        if (!(z > 0) || cloud.pixel_of(i) >= pixels) continue;
        const double stored = std::round(z * intrinsics.depth_scale);
        frame.depth[cloud.pixel_of(i)] =
            static_cast<std::uint16_t>(std::clamp(stored, 1.0, 65535.0));
    }
    return true;
}

}  // namespace topple::geometry
