// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "safety/body_parts.h"
#include "safety/directions.h"
#include "safety/fields.h"

namespace topple::safety {

// The secondary motion on the map's grid: where a walker stands relative to a cell that one of the
// body's parts passes through. A part that reaches l to the side passes everything up to l, and
// with a chance that falls linearly to 0 what lies up to wander_m further out, since walkers stray
// from their path. Along the path its weights add up to 1: one walk past a cell is one pass.
struct Footprint {
    struct Offset {
        std::int32_t x, y;  // cells, from the cell to the walker
    };
    std::int32_t radius = 0;      // largest |x| or |y|
    std::vector<Offset> offsets;  // by y, then x
    // Entries of (part, direction): [first[i], first[i + 1]) with i = part * direction_count +
    // direction.
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> row;  // index into offsets
    std::vector<float> weight;
};
Footprint make_footprint(double cell_m, const HumanOptions& options);

// The straight lines from a cell to each offset, as steps for the kernel disturbance_reach.
struct SightLines {
    std::vector<std::uint32_t> first;  // offsets + 1
    std::vector<std::int32_t> a, b;    // index differences in a map of `width` cells a row
};
SightLines sight_lines(const Footprint& footprint, std::int32_t width);

// Height bands: the body's height in 32 equal parts, so that one word holds a bit for each.
inline constexpr unsigned band_count = 32;
// The bands whose middle lies within the part.
struct Bands {
    unsigned first = 0, count = 0;
};
Bands bands_of(const BodyPart& part);

}  // namespace topple::safety
