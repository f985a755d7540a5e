// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "topple/input.h"

namespace topple::io {

enum class MeshFormat : std::uint8_t { obj, ply, stl, glb, gltf };

// Points on the faces of a mesh, with the faces' normals, by the order of their corners: equally
// many on equal areas, about 1 cm apart, but no fewer than 50,000 of them and no more than
// 5,000,000. In the file's unit, of which one has `unit_m` metres, and in its frame: nodes are
// placed, and nothing is turned (glTF's up is y). The same file gives the same points. Empty where
// no face has an area. `bytes` is the whole file; only a .gltf is read together with the files that
// it names. Throws Error(input).
std::optional<PointCloud> parse_mesh(const std::filesystem::path& file, std::string_view bytes,
                                     MeshFormat format, double unit_m);

}  // namespace topple::io
