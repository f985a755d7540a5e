// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace topple {

// Why a voxel is taken to be solid.
enum class Basis : std::uint8_t {
    surface,      // points lie in it, or a map says so
    three_votes,  // rays from it meet one primitive in three directions or more
    two_votes,    // in two
    column,       // it hides under a top, down to where that stands
    stand,        // it was filled with what stands on its primitive, which goes on below that
    leg,          // a slender part ends hidden below a wider one
    gap,          // nobody saw into the gap between two primitives
};
inline constexpr std::uint8_t basis_count = 7;

// How probable it is that such a voxel is solid indeed, to within half of its diagonal.
double probability_solid(Basis basis);

}  // namespace topple
