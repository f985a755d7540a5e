// SPDX-License-Identifier: MIT
#include "core/short_number.h"

#include <cstdio>

namespace topple {

std::string short_number(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.6g", value);
    return text;
}

}  // namespace topple
