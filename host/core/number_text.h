// SPDX-License-Identifier: MIT
#pragma once

#include <string>

// Numbers as text, the same whatever locale the host program has set: printf() and streams would
// write "0,25" there, or "1.000". See short_number.h, too.
namespace topple {

// As printf's %.3g: to so many digits.
std::string to_digits(double value, int digits);
// As printf's %.3f: with so many places after the point.
std::string to_places(double value, int places);

}  // namespace topple
