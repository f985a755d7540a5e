// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "export/convex_part.h"
#include "export/visual.h"

// Meshes as Wavefront OBJ, in a body's frame.
namespace topple::exports {

// The part's hull, triangles; center_m: of the body.
std::string part_obj(const ConvexPart& part, const Vec3& center_m);

// What is seen of a body; one colour for each triangle, of material_file by `colour_file`.
std::string visual_obj(const Visual& visual);

inline constexpr const char* material_file = "colours.mtl";
inline constexpr const char* colour_file = "colours.png";  // colour_texture()
std::string material();

}  // namespace topple::exports
