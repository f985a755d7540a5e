// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/colour_space.h"
#include "topple/input.h"

namespace topple {

// The surface of an object's solids, closed: each edge has two triangles that walk it in opposite
// directions, where vertices in one place count as one. At creases there are several in one place,
// one for each normal. The input's frame, metres.
struct ObjectSurface {
    std::int32_t object = -1;  // -1: of what belongs to none
    std::vector<Vec3> vertex, normal;
    std::vector<std::optional<Rgb8>> colour;             // of each vertex, in the scan; or empty
    std::vector<std::array<std::uint32_t, 3>> triangle;  // counter-clockwise seen from outside
    std::vector<std::int32_t> primitive;                 // of each triangle
};

}  // namespace topple
