// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace topple::io {

// The colour of an object or primitive, the same in every file that shows it: sRGB, told apart well
// by neighbours in number; grey for -1.
std::array<std::uint8_t, 3> colour_of(std::int32_t id);

}  // namespace topple::io
