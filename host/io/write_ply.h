// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "topple/scene.h"

// The two clouds of a result, as binary little-endian PLY. Metres, input frame. Both throw
// Error(input) where the file can't be written, std::invalid_argument where arrays differ in
// length.
namespace topple::io {

// points.ply: x y z float, primitive object int, nx ny nz float (where there are normals),
// red green blue uchar by object.
void write_points_ply(const std::filesystem::path& file, const ScenePoints& points);

// solid.ply: x y z float, primitive object int, state uchar (0 seen surface, 1 completed),
// red green blue uchar by object.
void write_solid_ply(const std::filesystem::path& file, const SolidVoxels& voxels);

}  // namespace topple::io
