// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "io/text.h"

namespace topple::io {

// "7.5 cm", from 10 cm on "0.12 m".
inline std::string length_text(double metres) {
    return metres < 0.1 ? two_digits(100 * metres) + " cm" : two_digits(metres) + " m";
}

}  // namespace topple::io
