// SPDX-License-Identifier: MIT
#include "cli/acceleration_option.h"

#include <algorithm>

#include "io/text.h"
#include "safety/earthquake/acceleration_units.h"
#include "topple/error.h"

namespace topple::cli {

Acceleration parse_acceleration(const char* option, const std::string& text) {
    const std::size_t unit_at = std::min(text.size(), text.find_first_of("gmcGMC"));
    const bool with_unit = unit_at < text.size();
    const auto unit = with_unit ? io::acceleration_unit_m_s2(text.substr(unit_at)) : 1.0;
    double value = 0;
    if (!unit || !io::parse_number(text.substr(0, unit_at), value))
        throw Error(ErrorKind::usage, std::string(option) + " " + text +
                                          ": expected a number in m/s^2, or one in g as in 0.3g");
    return {value * *unit, with_unit};
}

}  // namespace topple::cli
