// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

namespace topple::geometry {

// The part that a primitive plays in the room's shell. What is built in counts as wall.
enum class Structure : std::uint8_t { none, floor, wall, ceiling };

// Of a building, or a part of one: what lies beyond its edge is not seen, and walls have rooms on
// both sides.
struct StoreyHint {
    double floor_m = 0;  // height of the storey's floor along up; NaN: not known
    double below_m = -std::numeric_limits<double>::infinity();  // where the storey begins
    double top_m = std::numeric_limits<double>::infinity();     // where the next one begins
};

}  // namespace topple::geometry
