// SPDX-License-Identifier: MIT
#pragma once

// Measures of the rooms that people build. Set by hand.
namespace topple {

// Floors are larger, and table tops smaller, m^2.
inline constexpr double least_floor_m2 = 4;

// Farther from the origin than this, a room is not described in metres: at 1e6 a float resolves 6
// cm.
inline constexpr double farthest_m = 1e6;

// Ceilings hang no lower above their floors, metres.
inline constexpr double lowest_room_m = 2.0;

}  // namespace topple
