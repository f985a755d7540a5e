// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace topple {

// To six digits, without zeros at its end: "0.025".
std::string short_number(double value);

}  // namespace topple
