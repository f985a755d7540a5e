// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "core/basis.h"

namespace topple::vdb {

// What the upward ray, the level ones and the downward ray of a voxel end at, as kernel
// six_fill_vote counts them, and whether two of all meet the same primitive.
inline constexpr unsigned ends_above = 4, most_sides = 4, ends_below = 5;
inline constexpr unsigned all_ends = 2 * ends_above * (most_sides + 1) * ends_below;
constexpr unsigned ends_of(bool agree, unsigned above, unsigned sides, unsigned below) {
    return ((agree * ends_above + above) * (most_sides + 1) + sides) * ends_below + below;
}

// How likely an unseen voxel is solid whose rays end there, percent. What is solid has something of
// itself above it and at two sides; where all four sides are seen but space above it, it lies in a
// cup. Shares of 776,466 voxels of 80 rooms of 16 kinds, seeds 51 to 55, as the generator's walks,
// lasers, sparse clouds and single frames show them; the like of which counts
//   topple evaluate --rays
// Rows: what the upward ray ends at, first where no two rays meet the same primitive; in each, for
// no to four sides that meet a back: the ground, a primitive's back, its front, seen empty, else.
// clang-format off
inline constexpr std::array<std::uint8_t, all_ends> solid_percent{
    29,30,10, 7,20,  63,34,32,17,37,  82,49,63,39,59,  76,61,74,47,69,  77,79,87,88,79,
    18,13, 3,12, 6,  41,25,17,23,23,  68,40,43,41,55,  65,54,54,59,58,  37,34,34,39,34,
    11, 6, 1, 4, 2,  24,20, 8,13,16,  58,39,29,37,35,  60,52,44,55,51,  54,54,57,60,52,
     6, 6, 1, 1, 3,  12,13, 8, 4,14,  36,33, 7,19,28,  44,36,46,49,49,  35,26,26,30,26,

    35,16,12,14,15,  83,36,42,52,43,  92,57,74,71,68,  88,76,80,81,77,  86,88,86,93,85,
    14,15,13, 8,14,  46,28,24,26,28,  80,44,46,55,62,  86,51,56,64,66,  77,74,73,81,75,
    15, 8, 7, 7, 7,  17,17, 2,11,10,  55,40,15,50,40,  42,51,11,59,39,  26,48, 7,54,27,
     3, 5, 4, 2, 3,  16,24, 3, 6,11,  33,28,14,19,28,  26,43,37,53,45,  19,61,32,45,33,
};
// clang-format on
inline double fill_chance(unsigned ends) {
    return solid_percent[ends] / 100.0;
}
// What filling takes goes where it is less likely than that, and what it does not take comes where
// it is more: between them rooms differ more from one another than the table tells.
inline constexpr double unlikely_chance = 0.3, surely_chance = 0.7;
inline bool is_surely(unsigned ends) {
    return fill_chance(ends) > surely_chance;
}

// From there on a voxel counts as enclosed.
inline constexpr double enclosed_chance = 0.8;
inline Basis basis_of(unsigned ends) {
    return fill_chance(ends) > enclosed_chance   ? Basis::enclosed
           : fill_chance(ends) > unlikely_chance ? Basis::half_enclosed
                                                 : Basis::unlikely;
}

}  // namespace topple::vdb
