// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "physics/directions.h"
#include "safety/human/secondary_motion.h"

namespace topple::safety {

// The secondary motion on the map's grid: where a walker stands relative to a cell that a layer
// passes through.
struct Footprint {
    struct Offset {
        std::int32_t x, y;  // cells, from the cell to the walker
    };
    std::int32_t radius = 0;      // largest |x| or |y|
    std::vector<Offset> offsets;  // by y, then x
    // Entries of (layer, direction of the strike): [first[i], first[i + 1]) with i = layer *
    // direction_count + direction.
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> row;     // index into offsets
    std::vector<std::uint8_t> heading;  // of the walker
    std::vector<float> weight;
};
Footprint make_footprint(double cell_m, const SecondaryMotion& motion);

// The straight lines from a cell to each offset, as steps for the kernel disturbance_reach.
struct SightLines {
    std::vector<std::uint32_t> first;  // offsets + 1
    std::vector<std::int32_t> a, b;    // index differences in a map of `width` cells a row
};
SightLines sight_lines(const Footprint& footprint, std::int32_t width);

}  // namespace topple::safety
