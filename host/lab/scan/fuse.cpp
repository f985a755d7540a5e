// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "lab/scan/depth_camera.h"
#include "lab/scores/majority.h"

namespace topple::scenes {
namespace {

struct Reading {
    std::int64_t cell[3];
    std::uint32_t at;
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
            x.push_back(static_cast<float>(pose[0] * u + pose[1] * v + pose[2] * d + pose[3]));
            y.push_back(static_cast<float>(pose[4] * u + pose[5] * v + pose[6] * d + pose[7]));
            z.push_back(static_cast<float>(pose[8] * u + pose[9] * v + pose[10] * d + pose[11]));
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
        const float p[3] = {x[n], y[n], z[n]};
        for (int a = 0; a < 3; ++a) {
            readings[n].cell[a] = static_cast<std::int64_t>(std::floor(p[a] / options.fuse_m));
        }
        readings[n].at = static_cast<std::uint32_t>(n);
    }
    const auto same = [](const Reading& a, const Reading& b) {
        return std::equal(a.cell, a.cell + 3, b.cell);
    };
    std::sort(readings.begin(), readings.end(), [](const Reading& a, const Reading& b) {
        for (int k3 = 0; k3 < 3; ++k3) {
            if (a.cell[k3] != b.cell[k3]) return a.cell[k3] < b.cell[k3];
        }
        return a.at < b.at;
    });
    std::vector<std::int32_t> labels;
    for (std::size_t first = 0; first < readings.size();) {
        std::size_t end = first;
        double sum[3] = {0, 0, 0};
        labels.clear();
        for (; end < readings.size() && same(readings[first], readings[end]); ++end) {
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

}  // namespace topple::scenes
