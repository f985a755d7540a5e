// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/json.h"
#include "io/json_text.h"
#include "io/text.h"
#include "topple/input.h"

namespace topple {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t largest_hazard_bytes = 10'000'000;

std::vector<double> hazard_numbers(const fs::path& file, const Json& json, const char* name) {
    const auto found = json.find(name);
    if (found == json.end() || !found->is_array())
        io::fail(file, "has no list " + io::in_quotes(name) +
                           "; a hazard curve has \"pga_g\" and \"per_year\", lists of numbers");
    std::vector<double> out;
    for (const Json& value : *found) {
        if (!value.is_number())
            io::fail(file, io::in_quotes(name) + " holds " + value.type_name() +
                               " where a number is due");
        out.push_back(value.get<double>());
    }
    return out;
}

HazardCurve hazard_of_lines(const fs::path& file, std::string_view text) {
    HazardCurve out;
    io::Lines lines(text);
    for (std::string_view line; lines.next(line);) {
        std::string_view rest = line.substr(0, line.find('#'));
        const auto first = io::next_token(rest, true), second = io::next_token(rest, true);
        if (first.empty()) continue;
        double pga = 0, rate = 0;
        const bool header = out.pga_g.empty() && !io::parse_number(first, pga);
        if (header) continue;
        if (!io::parse_number(first, pga) || !io::parse_number(second, rate))
            io::fail(file, "line " + std::to_string(lines.number()) +
                               ": expected a peak acceleration in g and an annual rate");
        out.pga_g.push_back(pga);
        out.per_year.push_back(rate);
    }
    return out;
}

}  // namespace

HazardCurve read_hazard_curve(const fs::path& file) {
    const auto bytes = io::read_file(file, largest_hazard_bytes);
    std::string_view text = bytes.text();
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
    const auto first = text.find_first_not_of(" \t\r\n");
    HazardCurve out;
    if (first != std::string_view::npos && text[first] == '{') {
        const Json json = io::parse_json(file, text);
        out.pga_g = hazard_numbers(file, json, "pga_g");
        out.per_year = hazard_numbers(file, json, "per_year");
    } else {
        out = hazard_of_lines(file, text);
    }
    out.source = file.string();
    if (out.pga_g.size() != out.per_year.size())
        io::fail(file, "has " + io::counted(out.pga_g.size(), "peak") + ", but " +
                           io::counted(out.per_year.size(), "rate"));
    if (const auto wrong = out.fault()) io::fail(file, *wrong);
    return out;
}

std::optional<std::string> HazardCurve::fault() const {
    if (pga_g.size() < 2 || pga_g.size() != per_year.size())
        return "a hazard curve needs at least 2 peak accelerations, each with its annual rate";
    for (std::size_t n = 0; n < pga_g.size(); ++n) {
        const std::string which = "point " + std::to_string(n + 1) + ": ";
        if (!(pga_g[n] > 0 && pga_g[n] <= 10))
            return which + "its peak is " + io::short_number(pga_g[n]) +
                   ", but must be above 0 and at most 10 g";
        if (!(per_year[n] > 0 && per_year[n] <= 1e6))
            return which + "its rate is " + io::short_number(per_year[n]) +
                   ", but must be above 0 a year";
        if (n == 0) continue;
        if (pga_g[n] <= pga_g[n - 1] || per_year[n] > per_year[n - 1])
            return which + "peaks must rise, and the rates at which they are exceeded fall";
    }
    return std::nullopt;
}

}  // namespace topple
