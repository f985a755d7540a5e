// SPDX-License-Identifier: MIT
#include "perf/peers/octomap_carving.h"

#include <octomap/OcTree.h>

#include <chrono>

namespace topple::perf {
namespace {

octomap::Pointcloud readings(const Intrinsics& k, const DepthFrame& frame) {
    octomap::Pointcloud points;
    const Mat4& pose = frame.camera_to_world;
    for (std::size_t at = 0; at < frame.depth.size(); ++at) {
        if (frame.depth[at] == 0) continue;
        const double d = frame.depth[at] / k.depth_scale;
        const double u = (static_cast<double>(at % k.width) - k.cx) / k.fx * d;
        const double v = (static_cast<double>(at / k.width) - k.cy) / k.fy * d;
        const auto world = [&](std::size_t row) {
            return static_cast<float>(pose[4 * row] * u + pose[4 * row + 1] * v +
                                      pose[4 * row + 2] * d + pose[4 * row + 3]);
        };
        points.push_back(world(0), world(1), world(2));
    }
    return points;
}

}  // namespace

std::optional<PeerMap> octomap_carving(
    const Intrinsics& intrinsics, std::span<const DepthFrame> frames, double voxel_m,
    const std::function<void(std::int32_t, std::int32_t, std::int32_t, bool)>& visit) {
    octomap::OcTree tree(voxel_m);
    PeerMap out;
    out.library = "OctoMap";
    for (const DepthFrame& frame : frames) {
        const octomap::Pointcloud points = readings(intrinsics, frame);
        const Mat4& pose = frame.camera_to_world;
        const octomap::point3d eye(static_cast<float>(pose[3]), static_cast<float>(pose[7]),
                                   static_cast<float>(pose[11]));
        const auto start = std::chrono::steady_clock::now();
        tree.insertPointCloud(points, eye);
        out.seconds +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        out.rays += points.size();
    }
    constexpr std::int32_t middle = 32768;  // the key of the voxel from the origin
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
        // A pruned node stands for a cube of voxels.
        const std::int32_t size = 1 << (tree.getTreeDepth() - leaf.getDepth());
        const octomap::OcTreeKey key = leaf.getIndexKey();
        const bool occupied = tree.isNodeOccupied(*leaf);
        for (std::int32_t i = 0; i < size; ++i)
            for (std::int32_t j = 0; j < size; ++j)
                for (std::int32_t k = 0; k < size; ++k)
                    visit(key[0] - middle + i, key[1] - middle + j, key[2] - middle + k, occupied);
    }
    return out;
}

}  // namespace topple::perf
