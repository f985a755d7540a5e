// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>

#include "core/object_surface.h"
#include "topple/scene.h"
#include "vdb/voxel_scene.h"

namespace topple {

// Writes the solids as a binary glTF: a closed surface per object, named "object N" and coloured as
// in the scan or, where that has no colours, by its unsafety, grey where it is grounded; what
// belongs to none is "unassigned". Vertices are in the input's frame; the root node turns up to
// glTF's y. Throws Error(input) where the file can't be written.
void write_objects_glb(const std::filesystem::path& file, const Scene& scene,
                       std::span<const ObjectSurface> surfaces, const vdb::VoxelFrame& frame);

}  // namespace topple
