// SPDX-License-Identifier: MIT
#pragma once

#include "safety/fields.h"

// How unsafe an object is by itself, whatever else is in the scene: a risk matrix of how likely one
// event makes it fall, and how hard it then falls (ISO 31010 describes such matrices).
namespace topple::safety {

enum class Category { none, low, medium, high };
const char* to_string(Category category);

// Chances per event: rare below the first, unlikely, possible, and likely from the last on. Our
// choice: decades.
inline constexpr double unlikely_chance = 1e-3, possible_chance = 1e-2, likely_chance = 1e-1;
// Energies of a fall: negligible below the first (our choice), slight, serious and deadly. 15 J, 11
// foot-pounds, is the least that US ranges count as hazardous to people in the open (14 CFR
// 417.107(c)); 79 J, 58 foot-pounds, is a hazardous fragment of US explosives safety (DESR
// 6055.09).
inline constexpr double slight_J = 1, serious_J = 15, deadly_J = 79;

// none: it does not fall, falls with less than slight_J, or both rarely and slightly. Else each
// step of either counts as much: low, medium from 4 of them, high from 5.
//                slight  serious  deadly
//     likely     medium  high     high
//     possible   low     medium   high
//     unlikely   low     low      medium
//     rare       none    low      low
Category category(double chance, double energy_J);

// The worst category over the disturbances: as measured, and at both ends of what is known, `lower`
// where barriers are one standard error lower and masses higher, `higher` where it is the other way
// round. Rocking is not monotone: what goes over to a wall sooner may fall the other way less
// often, so that the lower end need not be the worst.
struct CategoryEnds {
    Category lower = Category::none, measured = Category::none, higher = Category::none;
    Category worst() const;
    bool certain() const;  // all three are the same
};
// One disturbance's category, its energy being the mean of what it releases when it makes the
// object fall.
Category category(const Risk& risk, double mass_factor);

}  // namespace topple::safety
