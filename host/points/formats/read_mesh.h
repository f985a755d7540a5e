// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "topple/input.h"

namespace topple::io {

enum class MeshFormat : std::uint8_t { obj, ply, stl, glb, gltf };

// How many points the faces of a mesh get: as many as lie so far apart, within limits.
struct MeshSampling {
    double spacing_m = 0.01;
    std::uint64_t fewest = 50'000, most = 5'000'000;
};

// Points on the faces of a mesh, with the faces' normals, by the order of their corners, but
// for what find_sides() turns (mesh_sides.h): equally many on equal areas, as `sampling` says. A
// mesh of nothing but points is a cloud. In the file's unit, of which one has `unit_m` metres, and
// in its frame: nodes are placed, and nothing is turned (glTF's up is y). With colours where the
// mesh has any: see MeshColours. The same file gives the same points. Empty where no face has an
// area. `bytes` is the whole file; only a .gltf is read together with the files that it names.
// Throws Error(input).
std::optional<PointCloud> parse_mesh(const std::filesystem::path& file, std::string_view bytes,
                                     MeshFormat format, double unit_m,
                                     const MeshSampling& sampling = {});

}  // namespace topple::io
