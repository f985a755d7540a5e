// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace topple::geometry {

// A level's surface spreads over its noise.
inline constexpr double level_spread_m = 0.05;

// Where a building may be cut between its storeys: in the slab between a ceiling and the floor
// above.
struct Storey {
    double floor_m = 0;  // height of its floor along up
    double below_m = 0;  // where it begins: the middle of the slab below its floor
};

// Of a building, or a part of one: what lies beyond its edge is not seen, and walls have rooms on
// both sides.
struct StoreyHint {
    double floor_m = 0;  // height of the storey's floor along up; NaN: not known
    double below_m = -std::numeric_limits<double>::infinity();  // where the storey begins
    double top_m = std::numeric_limits<double>::infinity();     // where the next one begins
};

// Storeys by rising height; the first begins at minus infinity. area_m2: level histogram of the
// surface, `step_m` a step, the first of which begins at low_m. Floors and ceilings hold much more
// surface than any height between them; a level that lies closely above another is the floor on
// that one's slab. A scan without such levels is one storey, whose floor is its lowest such level,
// or NaN.
std::vector<Storey> find_storeys(const std::vector<double>& area_m2, double low_m, double step_m);

}  // namespace topple::geometry
