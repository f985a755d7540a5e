// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/closed_furniture.h"

// What several things of one make tell of each other: bookcases along the walls, chairs around a
// table. Each was seen from elsewhere and completed by itself, so they are repeated measurements.
namespace topple::physics {

// By object, all others whose smallest upright boxes have its sides and height, each to within 15 %
// of the larger: rising. What has no box has none.
using Repeated = std::vector<std::vector<std::int32_t>>;
Repeated find_repeated(std::span<const FurnitureLooks> looks);

struct ClosedOdds {
    double probability = 0;  // that it is closed furniture
    // Share of the ways that voxels may fall by which it is likelier closed than not: 0 or 1 but
    // for what is near the border of both, which another origin of the same scan puts on either
    // side.
    double closed_ways = 0;
};

// By object, for what is alike being of one kind: what the looks of each add to the log-odds of
// closed_share, summed over its own and those that are alike and fill their boxes enough to tell. 0
// for what does not itself.
std::vector<ClosedOdds> closed_odds(std::span<const FurnitureLooks> looks, const Repeated& alike);

// One standard error that the masses of alike things show: their logarithms differ by the root of
// two times what each is off, in the mean of squares; the mass less than which it then is one
// deviation down is taken for either side, so that no mass is within its error of nothing. 0 for
// what has none.
double error_among_alike_kg(std::span<const double> mass_kg, std::span<const std::int32_t> alike,
                            std::size_t object);

}  // namespace topple::physics
