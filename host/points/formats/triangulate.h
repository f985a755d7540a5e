// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "topple/input.h"

namespace topple::io {

// Triangles of a polygon by its corners' numbers, turning the way that it does: ears are cut off
// where one fits, which is everywhere in a flat polygon that doesn't cross itself. What no ear
// fits, and polygons of more than 1,000 corners, become fans.
std::vector<std::array<std::size_t, 3>> triangulate(const std::vector<Vec3>& polygon);

}  // namespace topple::io
