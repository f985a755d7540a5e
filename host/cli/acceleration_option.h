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

// What to say of one so weak that it was meant in g, perhaps, or so strong that it was meant in
// hundredths of g; "" of others.
std::string unlikely_shaking_note(const Acceleration& pga);

}  // namespace topple::cli
