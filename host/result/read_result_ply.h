// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "io/open_file.h"
#include "topple/scene.h"

// Reads back the clouds of a result that write_ply.h writes. Both throw Error(input) where the file
// is missing, damaged or another program's.
namespace topple::io {

// Of points.ply: coordinates, parts and objects; normals where there are any, and the scan's own
// colours where it has some.
ScenePoints read_points_ply(const FileName& file);

// Of solid.ply.
SolidVoxels read_solid_ply(const FileName& file);

}  // namespace topple::io
