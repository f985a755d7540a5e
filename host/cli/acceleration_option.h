// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace topple::cli {

// --pga: a number in m/s^2, or with a unit: 0.3g, 2.9m/s2.
struct Acceleration {
    double m_s2 = 0;
    bool with_unit = false;
};
// Throws Error(usage).
Acceleration parse_acceleration(const char* option, const std::string& text);

}  // namespace topple::cli
