// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "topple/input.h"
#include "vdb/voxel_scene.h"

// Depth frames as the carving kernels read them.
namespace topple::vdb {

// Words of all levels of one frame: the finest has (width - 1) * (height - 1), each next half of
// both sides, rounded up, down to a single word.
std::uint64_t pyramid_words(const Intrinsics& intrinsics);

// Writes the levels, finest first: min | max << 16 of the stored depths of each 2x2 pixels (0: no
// reading), then of each 2x2 words of the level above. out.size() == pyramid_words().
void build_pyramid(const Intrinsics& intrinsics, std::span<const std::uint16_t> depth,
                   std::span<std::uint32_t> out);

// Three rows (U, V, Z), each affine in the index of a voxel relative to `reference`: a voxel's
// centre is seen at pixel (U / Z, V / Z) in depth Z, metres.
std::array<float, 12> camera_rows(const VoxelFrame& frame,
                                  const std::array<std::int32_t, 3>& reference,
                                  const Intrinsics& intrinsics, const Mat4& camera_to_world);

}  // namespace topple::vdb
