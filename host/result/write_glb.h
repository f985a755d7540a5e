// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "topple/input.h"

namespace topple::io {

struct GlbMesh {
    std::vector<Vec3> vertex;
    std::vector<Vec3> normal;  // of each vertex; or empty, for flat triangles
    std::vector<std::array<std::uint32_t, 3>> triangle;  // counter-clockwise seen from outside
};

struct GlbNode {
    std::string name;
    std::array<std::uint8_t, 3> colour{};  // sRGB
    GlbMesh mesh;                          // the input's frame, metres
    // sRGB, of each vertex, instead of `colour`; or empty.
    std::vector<std::array<std::uint8_t, 3>> vertex_colour{};
};

// Writes a binary glTF 2.0: one node per mesh below a root that turns them, by `y_up_from_input`,
// so that up is glTF's y. Throws Error(input) where the file can't be written.
void write_glb(const std::filesystem::path& file, const std::vector<GlbNode>& nodes,
               const std::array<Vec3, 3>& y_up_from_input);

}  // namespace topple::io
