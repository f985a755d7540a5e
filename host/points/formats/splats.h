// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "points/formats/ply_file.h"

// Gaussian splats in a PLY, as the authors of 3D Gaussian splatting (Kerbl and others, 2023) write
// them and others after them: x y z is a splat's centre, its opacity is stored as a logit, scale_0
// to scale_2 are logarithms, rot_0 to rot_3 a quaternion, and f_dc_0 to f_dc_2 the constant term of
// its colour's spherical harmonics.
namespace topple::io {

// Indices into the properties of a vertex.
struct SplatFields {
    std::size_t opacity = 0;
    std::array<std::size_t, 3> colour{};  // red, green, blue
};

// Where a vertex has all of those fields. Throws Error(input) where the file holds splats packed
// into integers, which are not read.
std::optional<SplatFields> splat_fields(const std::filesystem::path& file,
                                        const PlyElement& vertex);

// Whether the splat hides more than half of what lies behind its centre: such are mostly surfaces,
// others haze.
bool hides(double opacity_logit);

// 1 to 255 each: 0, 0, 0 would say that it is not known.
std::array<double, 3> splat_colour(const std::array<double, 3>& constant_term);

// What to know of the points: `taken` of `all` splats.
std::string splats_note(std::uint64_t taken, std::uint64_t all);

}  // namespace topple::io
