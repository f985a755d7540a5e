// SPDX-License-Identifier: MIT
#include "points/working_origin.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/vectors.h"

namespace topple {
namespace {

// at(n): coordinate n of `count`, finite.
template <class At>
double mode_of(std::size_t count, const At& at) {
    constexpr double bin_m = 0.01, steps_per_m = 1 << 20;  // sums of whole steps: no order counts
    constexpr std::size_t most_bins = 1 << 16;
    double low = INFINITY, high = -INFINITY;
    for (std::size_t n = 0; n < count; ++n) {
        low = std::min(low, at(n));
        high = std::max(high, at(n));
    }
    const double edge = std::max(bin_m, (high - low) / (most_bins - 2));
    std::vector<std::uint32_t> in_bin(static_cast<std::size_t>((high - low) / edge) + 2);
    for (std::size_t n = 0; n < count; ++n)
        ++in_bin[static_cast<std::size_t>((at(n) - low) / edge)];
    std::size_t best = 0;  // with the one after it, so that a plane between two counts whole
    for (std::size_t b = 1; b + 1 < in_bin.size(); ++b)
        if (in_bin[b] + in_bin[b + 1] > in_bin[best] + in_bin[best + 1]) best = b;
    double mode = low + edge * static_cast<double>(best + 1);
    std::vector<double> near;
    for (std::size_t n = 0; n < count; ++n)
        if (std::abs(at(n) - mode) < 4 * edge) near.push_back(at(n));
    for (int round = 0; round < 20; ++round) {
        std::int64_t sum = 0, within = 0;
        for (const double v : near) {
            if (!(std::abs(v - mode) < 1.5 * edge)) continue;
            sum += std::llround((v - mode) * steps_per_m);
            ++within;
        }
        if (within == 0) break;
        const double step = static_cast<double>(sum) / static_cast<double>(within) / steps_per_m;
        mode += step;
        if (std::abs(step) < 1 / steps_per_m) break;
    }
    return mode;
}

}  // namespace

Vec3 densest_planes(const CloudView& cloud) {
    Vec3 out{};
    const std::array<const FloatColumn*, 3> column{&cloud.x, &cloud.y, &cloud.z};
    for (std::size_t a = 0; a < 3; ++a)
        out[a] = mode_of(cloud.size(), [&](std::size_t n) { return double{(*column[a])[n]}; });
    return out;
}

Vec3 densest_planes(const FrameStream& frames, ThreadPool& threads) {
    constexpr std::size_t some_frames = 32, pixel_step = 29;
    const Intrinsics& k = frames.intrinsics();
    std::vector<Vec3> seen;
    const auto add = [&](const DepthFrame& frame, std::size_t) {
        const Mat4& m = frame.camera_to_world;
        for (std::size_t i = 0; i < frame.depth.size(); i += pixel_step) {
            if (frame.depth[i] == 0) continue;
            const double z = frame.depth[i] / k.depth_scale;
            const double x = (static_cast<double>(i % k.width) - k.cx) * z / k.fx;
            const double y = (static_cast<double>(i / k.width) - k.cy) * z / k.fy;
            Vec3& p = seen.emplace_back();
            for (std::size_t a = 0; a < 3; ++a)
                p[a] = m[4 * a] * x + m[4 * a + 1] * y + m[4 * a + 2] * z + m[4 * a + 3];
        }
    };
    for_each_frame(frames, threads, add,
                   {.step = std::max<std::size_t>(1, frames.size() / some_frames)});
    Vec3 out{};
    if (seen.empty()) return out;
    for (std::size_t a = 0; a < 3; ++a)
        out[a] = mode_of(seen.size(), [&](std::size_t n) { return seen[n][a]; });
    return out;
}

Vec3 origin_amid_voxels(const Vec3& planes, double voxel_m) {
    Vec3 out{};  // as clouds hold coordinates, so that nothing is lost where they are reckoned from
                 // it
    for (std::size_t a = 0; a < 3; ++a) out[a] = static_cast<float>(planes[a] - voxel_m / 2);
    return out;
}

void reckon_from(const Vec3& origin, Observation& input) {
    CloudView& cloud = input.cloud;
    if (cloud.has_viewpoint)
        cloud.viewpoint = minus(cloud.viewpoint, minus(origin, input.origin_m));
    input.origin_m = origin;
    const std::array<std::array<FloatColumn*, 2>, 3> columns{{{&cloud.x, &cloud.viewpoint_x},
                                                              {&cloud.y, &cloud.viewpoint_y},
                                                              {&cloud.z, &cloud.viewpoint_z}}};
    for (std::size_t a = 0; a < 3; ++a)
        for (FloatColumn* column : columns[a])
            *column = column->less(static_cast<float>(origin[a]));
}

}  // namespace topple
