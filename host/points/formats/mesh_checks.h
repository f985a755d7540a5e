// SPDX-License-Identifier: MIT
#pragma once

#include "points/formats/read_mesh.h"

namespace topple::io {

// Throws Error(input) where a mesh file's own counts and sizes contradict its length: what the
// library that reads it takes on trust; of glTF see gltf.h, and an OBJ has no counts.
void check_mesh(const std::filesystem::path& file, std::string_view bytes, MeshFormat format);

// Whether a PLY's header promises faces.
bool ply_has_faces(std::string_view bytes);

}  // namespace topple::io
