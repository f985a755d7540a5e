// SPDX-License-Identifier: MIT
#include "cli/option_values.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <sstream>

#include "io/text.h"
#include "safety/earthquake/acceleration_units.h"

namespace topple::cli {
namespace {

const std::map<std::string, double> size_units{
    {"", 1},         {"B", 1},      {"K", 0x1p10},   {"KiB", 0x1p10}, {"kB", 1e3},
    {"KB", 1e3},     {"M", 0x1p20}, {"MiB", 0x1p20}, {"MB", 1e6},     {"G", 0x1p30},
    {"GiB", 0x1p30}, {"GB", 1e9},   {"T", 0x1p40},   {"TiB", 0x1p40}, {"TB", 1e12}};

// The number that a text begins with, as programs in C read it, and how many letters it has; 0: it
// begins with none.
std::size_t leading_number(const std::string& text, double& value) {
    std::size_t used = 0;
    try {
        value = std::stod(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    return used;
}

}  // namespace

Error wrong_value(const std::string& option, const std::string& text, const std::string& expected) {
    return {ErrorKind::usage, option + " " + text + ": expected " + expected};
}

std::vector<std::string> split_commas(const std::string& text) {
    std::vector<std::string> parts;
    std::stringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    return parts;
}

Vec3 parse_vector(const std::string& option, const std::string& text, const char* expected) {
    const Error bad = wrong_value(option, text, expected);
    const std::vector<std::string> parts = split_commas(text);
    if (parts.size() != 3) throw bad;
    Vec3 out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t used = leading_number(parts[i], out[i]);
        if (used == 0 || used != parts[i].size() || !std::isfinite(out[i])) throw bad;
    }
    return out;
}

Vec3 parse_up(const std::string& option, const std::string& text) {
    constexpr const char* expected = "three numbers X,Y,Z, not all zero";
    const Error bad = wrong_value(option, text, expected);
    Vec3 up = parse_vector(option, text, expected);
    const double length = std::hypot(up[0], up[1], up[2]);
    if (!(length > 0) || !std::isfinite(length)) throw bad;
    for (double& c : up) c /= length;
    return up;
}

Acceleration parse_acceleration(const std::string& option, const std::string& text) {
    const std::size_t unit_at = std::min(text.size(), text.find_first_of("gmcGMC"));
    const bool with_unit = unit_at < text.size();
    const auto unit = with_unit ? io::acceleration_unit_m_s2(text.substr(unit_at)) : 1.0;
    double value = 0;
    if (!unit || !io::parse_number(text.substr(0, unit_at), value))
        throw wrong_value(option, text, "a number in m/s^2, or one in g as in 0.3g");
    return {value * *unit, with_unit};
}

std::optional<double> parse_contents(const std::string& option, const std::string& text) {
    if (text == "solid") return std::nullopt;
    double value = 0;
    if (!io::parse_number(text, value))
        throw wrong_value(option, text, "kg/m^3, a number from 0 on, or solid");
    return value;
}

std::uint64_t parse_size(const std::string& option, const std::string& text) {
    double value = 0;
    const std::size_t used = leading_number(text, value);
    const auto unit = size_units.find(text.substr(used));
    if (used == 0 || unit == size_units.end() || !(value * unit->second >= 1) ||
        value * unit->second > 0x1p60)
        throw wrong_value(option, text,
                          "a size such as 500M or 4G (of 1024), or 500MB or 4GB (of 1000)");
    return static_cast<std::uint64_t>(value * unit->second);
}

}  // namespace topple::cli
