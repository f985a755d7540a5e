// SPDX-License-Identifier: MIT
#include "cli/acceleration_option.h"

#include <algorithm>
#include <map>

#include "io/text.h"
#include "physics/landscape.h"
#include "safety/earthquake/intensity.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

const std::map<std::string, double>& acceleration_units() {
    static const std::map<std::string, double> units{
        {"", 1}, {"g", physics::gravity}, {"m/s2", 1}, {"m/s^2", 1}, {"cm/s2", 0.01}};
    return units;
}

}  // namespace

bool is_acceleration_unit(const std::string& word) {
    return !word.empty() && acceleration_units().contains(word);
}

Acceleration parse_acceleration(const char* option, const std::string& text) {
    const auto& units = acceleration_units();
    const std::size_t unit_at = std::min(text.size(), text.find_first_of("gmc"));
    const auto unit = units.find(text.substr(unit_at));
    double value = 0;
    if (unit == units.end() || !io::parse_number(text.substr(0, unit_at), value))
        throw Error(ErrorKind::usage, std::string(option) + " " + text +
                                          ": expected a number in m/s^2, or one in g as in 0.3g");
    return {value * unit->second, !unit->first.empty()};
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
