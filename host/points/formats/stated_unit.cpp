// SPDX-License-Identifier: MIT
#include "points/formats/stated_unit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "io/text.h"
#include "points/formats/scalar.h"
#include "points/formats/text_columns.h"

namespace topple::io {
namespace {

bool is_length(double metres) {
    return metres > 1e-6 && metres < 1e6;
}

// EPSG's codes of lengths, those that scans of buildings may have.
std::optional<double> metres_of_epsg(unsigned code) {
    static constexpr std::pair<unsigned, double> units[] = {{9001, 1},
                                                            {9002, 0.3048},
                                                            {9003, 1200.0 / 3937},
                                                            {9005, 0.3047972654},
                                                            {9041, 0.3047994715386762},
                                                            {9070, 0.3048008333},
                                                            {9080, 0.3047995102},
                                                            {9094, 0.3047997102},
                                                            {9095, 0.3048007491},
                                                            {9096, 0.9144},
                                                            {9036, 1000},
                                                            {1033, 0.01},
                                                            {1025, 0.001},
                                                            {109006, 0.01},
                                                            {109007, 0.001},
                                                            {109008, 0.0254}};
    for (const auto& [known, metres] : units)
        if (known == code) return metres;
    return std::nullopt;
}

std::optional<double> metres_of_name(std::string_view name) {
    using Names = std::array<std::string_view, 5>;
    static constexpr std::pair<Names, double> units[] = {
        {{"m", "meter", "meters", "metre", "metres"}, 1},
        {{"cm", "centimeter", "centimeters", "centimetre", "centimetres"}, 0.01},
        {{"mm", "millimeter", "millimeters", "millimetre", "millimetres"}, 0.001},
        {{"in", "inch", "inches"}, 0.0254},
        {{"ft", "foot", "feet"}, 0.3048}};
    for (const auto& [names, metres] : units)
        if (!name.empty() && std::ranges::find(names, name) != names.end()) return metres;
    return std::nullopt;
}

// What a LAS file says of its coordinates' system.
struct LasSystem {
    std::string_view keys, doubles, wkt;
};

// The records of one kind: `head` bytes each, of which the last 34 are a length and a description
// of 32, or 40 of the extended ones.
void look_at_records(std::string_view bytes, std::uint64_t at, std::uint64_t count, bool extended,
                     LasSystem& out) {
    const std::uint64_t head = extended ? 60 : 54;
    for (std::uint64_t n = 0; n < count && lies_in(bytes, at, head); ++n) {
        const auto id = value_at<std::uint16_t>(bytes, at + 18);
        const std::uint64_t length = extended ? value_at<std::uint64_t>(bytes, at + 20)
                                              : value_at<std::uint16_t>(bytes, at + 20);
        if (length > bytes.size() - at - head) return;
        if (bytes.substr(at + 2, 16).starts_with("LASF_Projection")) {
            const std::string_view body = bytes.substr(at + head, length);
            if (id == 34735) out.keys = body;
            if (id == 34736) out.doubles = body;
            if (id == 2112) out.wkt = body;
        }
        at += head + length;
    }
}

// A key's number, or its value among the doubles; 0 where there is none.
double key_of(const LasSystem& system, unsigned wanted) {
    const auto count = value_at<std::uint16_t>(system.keys, 6);
    for (std::uint64_t n = 1; n <= count && 8 * n + 8 <= system.keys.size(); ++n) {
        if (value_at<std::uint16_t>(system.keys, 8 * n) != wanted) continue;
        const auto value = value_at<std::uint16_t>(system.keys, 8 * n + 6);
        return value_at<std::uint16_t>(system.keys, 8 * n + 2) == 34736
                   ? value_at<double>(system.doubles, 8 * std::uint64_t{value})
                   : value;
    }
    return 0;
}

// Of the ground and of heights; 0: not stated.
struct LasUnits {
    double ground = 0, height = 0;
    bool degrees = false;
    std::string by;
};

double metres_of_key(const LasSystem& system, unsigned unit, unsigned size) {
    constexpr double own = 32767;  // as the key of its size says
    const double code = key_of(system, unit);
    const double metres = code == own ? key_of(system, size)
                                      : metres_of_epsg(static_cast<unsigned>(code)).value_or(0);
    return is_length(metres) ? metres : 0;
}

LasUnits units_of_keys(const LasSystem& system) {
    constexpr unsigned model_type = 1024, geographic = 2, ground = 3076, height = 4099;
    LasUnits out;
    out.ground = metres_of_key(system, ground, ground + 1);
    out.height = metres_of_key(system, height, 0);
    out.degrees = key_of(system, model_type) == geographic;
    out.by = "GeoKey " + std::to_string(out.ground > 0 ? ground : height);
    return out;
}

bool is_letter(char c) {
    return c >= 'a' && c <= 'z';
}

// A node of a WKT in small letters: where its name begins, and ends at a bracket.
struct WktNode {
    std::size_t begin = 0, bracket = 0;
    std::string_view name(std::string_view wkt) const { return wkt.substr(begin, bracket - begin); }
};
WktNode node_before(std::string_view wkt, std::size_t bracket) {
    std::size_t begin = bracket;
    while (begin > 0 && (is_letter(wkt[begin - 1]) || wkt[begin - 1] == '_')) --begin;
    return {begin, bracket};
}

// The node around another.
WktNode node_around(std::string_view wkt, const WktNode& node) {
    bool quoted = false;
    int depth = 0;
    for (std::size_t n = node.begin; n-- > 0;) {
        const char c = wkt[n];
        if (c == '"') quoted = !quoted;
        if (quoted) continue;
        if (c == ']' || c == ')') ++depth;
        if ((c == '[' || c == '(') && depth-- == 0) return node_before(wkt, n);
    }
    return {};
}

// The factors of units right within a system's definition, or of its axes; not those of its
// parameters, or of what it is derived from.
LasUnits units_of_wkt(std::string_view text) {
    constexpr std::size_t most_bytes = 16384;
    const std::string wkt = lower_case(text.substr(0, most_bytes));
    const auto is_one = [](std::string_view name, std::initializer_list<const char*> names) {
        return std::ranges::find(names, name) != names.end();
    };
    LasUnits out{.by = "its WKT"};
    for (std::size_t at = 0; (at = wkt.find_first_of("[(", at)) != std::string::npos; ++at) {
        const WktNode unit = node_before(wkt, at);
        if (!is_one(unit.name(wkt), {"unit", "lengthunit"})) continue;
        const auto comma = wkt.find(',', at);
        if (comma == std::string::npos) break;
        std::string_view rest = std::string_view(wkt).substr(comma + 1);
        rest = trimmed(rest.substr(0, rest.find_first_of(",])")));
        double metres = 0;
        if (!parse_number(rest, metres) || !is_length(metres)) continue;
        WktNode of = node_around(wkt, unit);
        if (of.name(wkt) == "axis") of = node_around(wkt, of);
        if (is_one(of.name(wkt), {"projcs", "projcrs", "projectedcrs", "local_cs", "engcrs"}))
            out.ground = metres;
        if (is_one(of.name(wkt), {"vert_cs", "vertcrs", "verticalcrs"})) out.height = metres;
    }
    const auto has = [&](const char* name) { return wkt.find(name) != std::string::npos; };
    out.degrees = has("geog") && !has("proj") && !has("local_cs") && !has("engcrs");
    return out;
}

}  // namespace

std::optional<StatedUnit> unit_of_las(const std::filesystem::path& file, std::string_view bytes) {
    LasSystem system;
    look_at_records(bytes, value_at<std::uint16_t>(bytes, 94), value_at<std::uint32_t>(bytes, 100),
                    false, system);
    if (value_at<std::uint8_t>(bytes, 25) >= 4)
        look_at_records(bytes, value_at<std::uint64_t>(bytes, 235),
                        value_at<std::uint32_t>(bytes, 243), true, system);
    LasUnits units = units_of_wkt(system.wkt);
    if (!(units.ground > 0 || units.height > 0)) {
        const bool degrees = units.degrees;
        units = units_of_keys(system);
        units.degrees = units.degrees || degrees;
    }
    if (units.degrees) {
        // A kilometre of degrees; files whose system is not their points' are as common.
        constexpr double few_degrees = 0.01;
        const double x = value_at<double>(bytes, 179) - value_at<double>(bytes, 187),
                     y = value_at<double>(bytes, 195) - value_at<double>(bytes, 203);
        if (x > 0 && y > 0 && std::max(x, y) < few_degrees) {
            fail(file, "its coordinates are degrees of longitude and latitude, over " +
                           short_number(x) + " by " + short_number(y) +
                           "; project them to metres, for example to UTM");
        }
        return std::nullopt;
    }
    if (!(units.ground > 0 || units.height > 0)) return std::nullopt;
    const double ground = units.ground > 0 ? units.ground : units.height;
    const double height = units.height > 0 ? units.height : units.ground;
    return StatedUnit{{ground, ground, height}, units.by};
}

std::optional<StatedUnit> unit_in_head(std::string_view head) {
    const std::string text = lower_case(head);
    const auto word_of = [](std::string_view& rest) {
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t:='\"[("), rest.size()));
        const std::string_view word(rest.begin(), std::ranges::find_if_not(rest, is_letter));
        rest.remove_prefix(word.size());
        return word;
    };
    Lines lines(text);
    for (std::string_view line; lines.next(line);) {
        for (std::size_t at = 0; (at = line.find("unit", at)) != std::string_view::npos;) {
            const bool begins = at == 0 || !is_letter(line[at - 1]);
            at += 4;
            std::string_view rest = line.substr(at);
            if (rest.starts_with('s')) rest.remove_prefix(1);
            if (!begins || (!rest.empty() && is_letter(rest.front()))) continue;
            // "units: mm", "unit = 'inch'", "units are in metres", "unit in".
            std::string_view word = word_of(rest);
            if (word == "is" || word == "are") word = word_of(rest);
            if (word == "in") {
                std::string_view after = rest;
                if (const auto next = word_of(after); !next.empty()) word = next;
            }
            if (const auto metres = metres_of_name(word))
                return StatedUnit{{*metres, *metres, *metres}, "its header"};
        }
    }
    return std::nullopt;
}

std::optional<StatedUnit> unit_of_names(std::string_view text) {
    Lines lines(text);
    std::string_view line;
    while (lines.next(line) && lines.number() < 100) {
        line = trimmed(line);
        if (!line.empty() && !line.starts_with('#') && !line.starts_with("//")) break;
    }
    // "x [mm]", "X(m)", "x_mm" of a column's name.
    const std::string names = lower_case(line.substr(0, 4096));
    for (std::size_t at = 0; (at = names.find('x', at)) != std::string::npos;) {
        if (at++ > 0 && is_letter(names[at - 2])) continue;
        std::string_view rest = std::string_view(names).substr(at);
        rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
        if (rest.empty() || std::string_view("[(_").find(rest.front()) == std::string_view::npos)
            continue;
        const std::string_view unit(rest.begin() + 1,
                                    std::find_if_not(rest.begin() + 1, rest.end(), is_letter));
        if (const auto metres = metres_of_name(unit))
            return StatedUnit{{*metres, *metres, *metres}, "its columns' names"};
    }
    return std::nullopt;
}

std::string leading_comments(std::string_view bytes) {
    constexpr std::uint64_t most_lines = 100;
    std::string out;
    Lines lines(bytes);
    for (std::string_view line; lines.number() < most_lines && lines.next(line);) {
        std::string_view rest = line;
        const auto first = next_token(rest);
        if (first == "end_header") break;
        if (first.starts_with('#') || first.starts_with("//") || first == "comment" ||
            first == "obj_info")
            out.append(line.substr(0, 1000)).append(1, '\n');
    }
    return out;
}

std::string unit_note(const StatedUnit& unit) {
    if (unit.by.empty() || unit.metres == Vec3{1, 1, 1}) return {};
    const bool one = unit.metres[0] == unit.metres[2];
    return "The unit of the file's coordinates is " + short_number(unit.metres[0]) + " m" +
           (one ? "" : ", that of its heights " + short_number(unit.metres[2]) + " m,") + " by " +
           unit.by +
           ", and was taken for that; if they are metres, correct it there, and if they are "
           "another, say unit_m (--unit).";
}

}  // namespace topple::io
