// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace topple::io {

// The lines of an OBJ that make its surface: vertices, with normals and what else begins with v,
// and faces. Groups, objects, materials and lines are no surface, and the library that reads the
// rest makes a kilobyte of each.
std::string obj_surface(std::string_view bytes);

// Of one without faces: its vertices as text with a point a line (formats.h); else "".
std::string obj_points(std::string_view surface);

}  // namespace topple::io
