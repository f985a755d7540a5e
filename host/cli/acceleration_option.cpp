// SPDX-License-Identifier: MIT
#include "cli/acceleration_option.h"

#include <algorithm>
#include <map>

#include "io/text.h"
#include "physics/landscape.h"
#include "safety/earthquake/intensity.h"
#include "topple/error.h"

namespace topple::cli {

Acceleration parse_acceleration(const char* option, const std::string& text) {
    static const std::map<std::string, double> units{
        {"", 1}, {"g", physics::gravity}, {"m/s2", 1}, {"m/s^2", 1}, {"cm/s2", 0.01}};
    const std::size_t unit_at = std::min(text.size(), text.find_first_of("gmc"));
    const auto unit = units.find(text.substr(unit_at));
    double value = 0;
    if (unit == units.end() || !io::parse_number(text.substr(0, unit_at), value))
        throw Error(ErrorKind::usage, std::string(option) + " " + text +
                                          ": expected a number in m/s^2, or one in g as in 0.3g");
    return {value * unit->second, !unit->first.empty()};
}

std::string weak_shaking_note(const Acceleration& pga) {
    constexpr double hardly_meant_m_s2 = 1;
    if (pga.with_unit || pga.m_s2 >= hardly_meant_m_s2) return "";
    const double in_g = pga.m_s2 / physics::gravity;
    const std::string given = io::short_number(pga.m_s2);
    std::string note = given;
    note.append(" m/s\u00b2 is ").append(io::two_digits(in_g)).append(" g (");
    note.append(safety::shaking_text(in_g)).append("): for ").append(given);
    return note.append(" g give --pga ").append(given).append("g.");
}

}  // namespace topple::cli
