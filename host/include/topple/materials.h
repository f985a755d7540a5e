// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "topple/input.h"

// What things of some kinds weigh, for scans in which nobody says what things are made of.
namespace topple {

struct ThingKind {
    std::string name;          // "mug": in small letters; an object's name has it as a word
    Vec3 size_m{};             // of its upright box, the shortest edge first
    double fill = 1;           // share of that box that is solid from outside: hollows closed count
    double density_kg_m3 = 0;  // mass over that solid's volume, the median of such things
    double spread = 0;         // the standard deviation of its logarithm among them
    double friction = 0;       // coefficient, of those so named; 0: that of all contacts
};

using Materials = std::vector<ThingKind>;

// Of some eighty things in homes and offices, from what such things weigh in shops, rounded.
const Materials& household_materials();

// What is wrong with the first kind that can't be used, with its number from 1; none: nothing.
std::optional<std::string> fault_of(const Materials& materials);

// A file of kinds (docs/disturbances.md), or household_materials() for "household". Throws
// Error(input) that names the file, the kind and what is wrong with it.
Materials read_materials(const std::filesystem::path& file);

}  // namespace topple
