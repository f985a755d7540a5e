// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "safety/fields.h"

// What the errors of an object's barrier and mass make of its risk.
namespace topple::safety {

// The objects with barriers that are one standard error lower, or higher (`errors` is -1 or 1), 0
// at least. What is not known is taken to be where the border of the support lies: it is so much
// further in or out as gives that barrier, all around. Barriers to tip go with the square of that,
// so that the roots of all of them shift by as much as that of the lowest.
std::vector<RiskObject> at_end(std::span<const RiskObject> objects, double errors);

// A risk at both ends: of barriers that are one standard error lower, and higher.
struct RiskEnds {
    Risk lower, higher;
};

// One standard error of a risk: that of the events it was found from, half of what lies between
// both ends, and the share by which the mass, and so the release, is uncertain; taken as
// independent.
double risk_error_J(const Risk& risk, const RiskEnds& ends, double mass_error_share);

}  // namespace topple::safety
