// SPDX-License-Identifier: MIT
#include "core/vectors.h"
#include "lab/scan/depth_camera.h"
#include "lab/scan/files.h"
#include "lab/scan/points.h"
#include "lab/scores/majority.h"
#include "lab/solids/ground_truth.h"
#include "lab/solids/rigid.h"

namespace topple::scenes {
namespace {

void add(PointCloud& cloud, const Vec3& p) {
    cloud.x.push_back(static_cast<float>(p[0]));
    cloud.y.push_back(static_cast<float>(p[1]));
    cloud.z.push_back(static_cast<float>(p[2]));
}

// All readings, in single precision as clouds hold them, with their parts.
std::vector<LabelledPoint> readings(const Sequence& sequence) {
    std::vector<LabelledPoint> out;
    for (std::size_t n = 0; n < sequence.frames.size(); ++n) {
        const DepthFrame& frame = sequence.frames[n];
        for (std::size_t at = 0; at < frame.depth.size(); ++at) {
            if (frame.depth[at] == 0) continue;
            const double z = frame.depth[at] / sequence.intrinsics.depth_scale;
            Vec3 p = moved(frame.camera_to_world, place_of(sequence.intrinsics, at, z));
            for (double& a : p) a = static_cast<float>(a);
            out.push_back({p, sequence.part[n][at]});
        }
    }
    return out;
}

}  // namespace

void fuse(const CameraOptions& options, Sequence& sequence) {
    const std::vector<LabelledPoint> points = readings(sequence);
    if (options.single) {
        for (const LabelledPoint& p : points) {
            add(sequence.cloud, p.at);
            sequence.part_of_point.push_back(p.object);
        }
        return;
    }
    std::vector<std::int32_t> labels;
    for_each_cube(points, options.fuse_m, [&](std::span<const Keyed> cube) {
        if (cube.size() < 2) return;
        Vec3 sum{};
        labels.clear();
        for (const Keyed& one : cube) {
            sum = along(sum, 1, points[one.at].at);
            labels.push_back(points[one.at].object);
        }
        for (double& a : sum) a /= static_cast<double>(cube.size());
        add(sequence.cloud, sum);
        sequence.part_of_point.push_back(majority(labels));
    });
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
