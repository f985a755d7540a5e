// SPDX-License-Identifier: MIT
#include "safety/earthquake/acceleration_units.h"

#include <string>

#include "io/text.h"

namespace topple::io {

std::optional<double> acceleration_unit_m_s2(std::string_view name) {
    const std::string lower = lower_case(name);
    if (lower == "g") return g_m_s2;
    for (const char* metres : {"m/s^2", "m/s2", "m/s/s", "m/s\u00b2", "m/sec^2", "m/sec2"})
        if (lower == metres) return 1;
    for (const char* gal :
         {"gal", "gals", "cm/s^2", "cm/s2", "cm/s/s", "cm/s\u00b2", "cm/sec^2", "cm/sec2"})
        if (lower == gal) return 0.01;
    return std::nullopt;
}

}  // namespace topple::io
