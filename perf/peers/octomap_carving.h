// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "topple/input.h"

// What OctoMap makes of depth frames, for comparison. nullopt where the build found none.
namespace topple::perf {

struct PeerMap {
    std::string library;  // its name and version
    double seconds = 0;   // wall time of insertPointCloud for all frames
    std::uint64_t rays = 0;
};

// Inserts every reading of the frames with OctoMap's default sensor model, then calls visit(i, j,
// k, occupied) for every voxel of the finest level that it knows: the one from (i, j, k) * voxel_m,
// in the frame of the poses.
std::optional<PeerMap> octomap_carving(
    const Intrinsics& intrinsics, std::span<const DepthFrame> frames, double voxel_m,
    const std::function<void(std::int32_t, std::int32_t, std::int32_t, bool)>& visit);

}  // namespace topple::perf
