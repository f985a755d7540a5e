// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

// Clouds larger than memory: sorted into cubes on disk, thinned there to one point a cell, and
// taken up again block by block.
namespace topple::tiles {

// A cube of the input's frame: bin (x, y, z) spans [x, x + 1] * bin_edge_m per axis.
using Bin = std::array<std::int32_t, 3>;

// About the size of a room: a bin's points fit into memory, and a building has few of them.
inline constexpr double bin_edge_m = 5;

inline Bin bin_of(float x, float y, float z) {
    return {static_cast<std::int32_t>(std::floor(x / bin_edge_m)),
            static_cast<std::int32_t>(std::floor(y / bin_edge_m)),
            static_cast<std::int32_t>(std::floor(z / bin_edge_m))};
}

// Points in the input's frame, metres.
struct Point {
    float x = 0, y = 0, z = 0;
};

}  // namespace topple::tiles
