// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "core/space_map.h"

namespace topple::io {

// Whether the file's extension is .bt or .ot.
bool looks_like_octomap(const std::filesystem::path& path);

// Reads an OctoMap, at its finest resolution: each occupied voxel of whose six neighbours one is
// not occupied becomes a point at its centre, with a normal towards the free voxels around; the
// other occupied ones are no surface, but solid; free leaves become free space. An .ot's leaf is
// occupied from a probability of one half on, as OctoMap's own default has it. One unit of the map
// has `unit_m` metres. poll: called now and then; what it throws ends the reading. Throws
// Error(input) where the file is damaged, has no occupied leaf, or more than `most_occupied`
// occupied voxels.
ScannedMap read_octomap(
    const std::filesystem::path& file, double unit_m = 1, const std::function<void()>& poll = [] {},
    std::uint64_t most_occupied = std::uint64_t{1} << 23);

// Writes what is known of space as an OctoMap (.bt), in voxels: 8x8x8 states for each leaf, as
// vdb::Tiles and VoxelScene::states() have them. Surface (1) is occupied and empty (0) is free;
// what nobody saw is unknown, whether it is taken for solid or not. Voxel (i, j, k) is the map's
// key 2^15 + (i, j, k). Throws Error(input) for voxels beyond the keys' 16 bits, or where the file
// can't be written.
struct OctomapLeaves {
    std::span<const std::int32_t> x, y, z;  // lowest voxels
    std::span<const std::uint8_t> states;   // 512 each
};
void write_octomap(const std::filesystem::path& file, double voxel_m, const OctomapLeaves& leaves);

}  // namespace topple::io
