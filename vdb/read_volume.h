// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/space_map.h"

namespace topple::vdb {

// Reads a surface from an OpenVDB file, of which one world unit has `unit_m` metres. What the file
// holds is told by its grids, the first that fits in this order:
//   signed distances  a float grid with active values above and below 0: the surface is where
//                     neighbouring active voxels change sign, its normal the gradient. Active
//                     voxels above 0 are free. What is not active is unknown, whatever its
//                     background says: a fused TSDF's has the sign of free space where nobody
//                     looked.
//   labels            an Int32 grid: active voxels above 0 are solid, and surface where a neighbour
//                     is not; active ones of 0 are free.
//   a fog volume      any other float grid: the surface is where it passes 0.5 (fog_threshold).
//                     Nothing is free: density says nothing of who looked.
// Points lie in world coordinates, with normals away from what is solid. Free space is kept where
// the grid's axes are the world's and its voxels are cubes; else a note says that it was left out.
// Throws Error(input) where the file is no OpenVDB, is damaged, or shows no surface.
ScannedMap read_volume(const std::filesystem::path& file, double unit_m = 1);

// What VoxelScene::write() has written: a point at the centre of each solid voxel, and what was
// seen to be free, in voxels of the grid, not of the world. Throws Error(input) where it is none.
ScannedMap read_states(const std::filesystem::path& file, double unit_m = 1);

inline constexpr float fog_threshold = 0.5f;

bool looks_like_volume(const std::filesystem::path& path);

}  // namespace topple::vdb
