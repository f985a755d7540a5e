// SPDX-License-Identifier: MIT
#include "cli/acceleration_option.h"

#include <algorithm>

#include "io/acceleration_units.h"
#include "io/text.h"
#include "physics/landscape.h"
#include "safety/earthquake/intensity.h"
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

std::string unlikely_shaking_note(const Acceleration& pga) {
    // Of the level peaks of strong-motion records only a few reach 2 g.
    constexpr double hardly_meant_m_s2 = 1, hardly_recorded_g = 2;
    const double in_g = pga.m_s2 / physics::gravity;
    const bool weak = !pga.with_unit && pga.m_s2 < hardly_meant_m_s2;
    if (!weak && in_g < hardly_recorded_g) return "";
    const std::string given = io::short_number(pga.m_s2);
    std::string note = given;
    note.append(" m/s\u00b2 is ").append(io::two_digits(in_g)).append(" g (");
    note.append(safety::shaking_text(in_g)).append(")");
    if (weak) return note + ": for " + given + " g give --pga " + given + "g.";
    note.append(", stronger than nearly all that were recorded");
    if (pga.with_unit) return note + ".";
    return note + "; was " + io::short_number(pga.m_s2 / 100) + "g meant?";
}

}  // namespace topple::cli
