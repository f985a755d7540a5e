// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/colour_space.h"

// One small picture that has all colours, for formats that give surfaces colours only by textures:
// sixteen levels of each channel, a texel each. All corners of a triangle point to the middle of
// one texel, so that nothing is blended.
namespace topple::exports {

// 0 to 4095: of the texel that is nearest to a colour.
std::uint32_t texel_of(const Rgb8& colour);

// Where its middle is: u from the left, v from below, 0 to 1.
std::array<double, 2> middle_of_texel(std::uint32_t texel);

// The picture as a PNG file.
std::string colour_texture();

}  // namespace topple::exports
