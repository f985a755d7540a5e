// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <compare>

#include "lab/scan/depth_camera.h"
#include "lab/scan/files.h"
#include "lab/scores/majority.h"
#include "lab/solids/ground_truth.h"
#include "lab/solids/rigid.h"

namespace topple::scenes {
namespace {

struct Reading {
    std::array<std::int64_t, 3> cell;
    std::uint32_t at;
    auto operator<=>(const Reading&) const = default;
};

}  // namespace

void fuse(const CameraOptions& options, Sequence& sequence) {
    const Intrinsics& k = sequence.intrinsics;
    std::vector<float> x, y, z;
    std::vector<std::int32_t> label;
    for (std::size_t n = 0; n < sequence.frames.size(); ++n) {
        const Mat4& pose = sequence.frames[n].camera_to_world;
        const auto& depth = sequence.frames[n].depth;
        for (std::size_t at = 0; at < depth.size(); ++at) {
            if (depth[at] == 0) continue;
            const double d = depth[at] / k.depth_scale;
            const double u = (static_cast<double>(at % k.width) - k.cx) / k.fx * d;
            const double v = (static_cast<double>(at / k.width) - k.cy) / k.fy * d;
            const Vec3 p = moved(pose, {u, v, d});
            x.push_back(static_cast<float>(p[0]));
            y.push_back(static_cast<float>(p[1]));
            z.push_back(static_cast<float>(p[2]));
            label.push_back(sequence.part[n][at]);
        }
    }
    PointCloud& cloud = sequence.cloud;
    if (options.single) {
        cloud.x = std::move(x);
        cloud.y = std::move(y);
        cloud.z = std::move(z);
        sequence.part_of_point = std::move(label);
        return;
    }
    std::vector<Reading> readings(x.size());
    for (std::size_t n = 0; n < x.size(); ++n) {
        const auto cell = [&](float p) {
            return static_cast<std::int64_t>(std::floor(p / options.fuse_m));
        };
        readings[n] = {{cell(x[n]), cell(y[n]), cell(z[n])}, static_cast<std::uint32_t>(n)};
    }
    std::sort(readings.begin(), readings.end());
    std::vector<std::int32_t> labels;
    for (std::size_t first = 0; first < readings.size();) {
        std::size_t end = first;
        double sum[3] = {0, 0, 0};
        labels.clear();
        for (; end < readings.size() && readings[end].cell == readings[first].cell; ++end) {
            const std::uint32_t at = readings[end].at;
            sum[0] += x[at];
            sum[1] += y[at];
            sum[2] += z[at];
            labels.push_back(label[at]);
        }
        if (end - first >= 2) {
            const auto count = static_cast<double>(end - first);
            cloud.x.push_back(static_cast<float>(sum[0] / count));
            cloud.y.push_back(static_cast<float>(sum[1] / count));
            cloud.z.push_back(static_cast<float>(sum[2] / count));
            sequence.part_of_point.push_back(majority(labels));
        }
        first = end;
    }
}

void write_cloud(const std::filesystem::path& path, const PointCloud& cloud) {
    std::string bytes;
    for (std::size_t k = 0; k < cloud.size(); ++k)
        append_place(bytes, cloud.x[k], cloud.y[k], cloud.z[k]);
    write_ply(path, cloud.size(), "", bytes);
}

void write_sequence(const std::filesystem::path& folder, const World& world,
                    const Sequence& sequence) {
    write_frames(folder, sequence.intrinsics, sequence.frames, 30);
    write_cloud(folder / "cloud.ply", sequence.cloud);
    write_truth(folder / "truth.json", world);
}

}  // namespace topple::scenes
