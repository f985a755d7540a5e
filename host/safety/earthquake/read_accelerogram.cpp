// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/json.h"
#include "io/json_text.h"
#include "io/text.h"
#include "safety/earthquake/acceleration_units.h"
#include "safety/earthquake/at2.h"
#include "topple/input.h"

namespace topple {
namespace {

namespace fs = std::filesystem;
using io::counted, io::fail, io::g_m_s2, io::in_quotes, io::lower_case, io::short_number;

// Strong motion lasts a minute or two, sampled 50 to 1000 times a second. More than an hour would
// only take long.
constexpr double shortest_step_s = 1e-5, longest_step_s = 0.5, longest_s = 3600;
constexpr std::size_t most_samples = 1'000'000;
constexpr std::uint64_t most_bytes = 100'000'000;
// Twice what was ever recorded horizontally; and more than all but a handful of records have.
constexpr double highest_g = 10, highest_assumed_g = 3;

const char* const mend = "name it with accelerogram_unit (--accelerogram-unit): g, m/s2 or cm/s2";

// The samples as a file has them.
struct Raw {
    std::vector<double> values;
    double step_s = 0;
    double factor = 1;
    std::optional<double> unit_m_s2;
};

double number_of(const fs::path& file, const Json& json, const std::string& what) {
    if (!json.is_number()) fail(file, what + " must be a number, not " + json.type_name());
    return json.get<double>();
}

// The entry that goes by one of the names; null where there is none.
struct Named {
    std::string name;
    const Json* json = nullptr;
};
Named find_named(const Json& json, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        const auto found = json.find(name);
        if (found != json.end()) return {in_quotes(name), &*found};
    }
    return {};
}

Raw read_json(const fs::path& file, std::string_view text) {
    const Json top = io::parse_json(file, text);
    if (!top.is_object())
        fail(file, std::string("must hold a JSON object, not ") + top.type_name());
    const Json* record = &top;
    if (const Named series = find_named(top, {"timeSeries", "timeseries"}); series.json) {
        if (!series.json->is_array() || series.json->size() != 1 ||
            !series.json->front().is_object())
            fail(file, series.name +
                           " must be a list of one record; give each of several in a file "
                           "of its own");
        record = &series.json->front();
    }
    Raw raw;
    const Named step = find_named(*record, {"dT", "dt", "DT"});
    if (!step.json) fail(file, "has no \"dT\"; add it: the time between two samples in seconds");
    raw.step_s = number_of(file, *step.json, step.name);
    const Named data = find_named(*record, {"accel_data", "data", "acceleration", "accel"});
    if (!data.json)
        fail(file, "has no \"accel_data\"; add it: the accelerations, as a list of numbers");
    if (!data.json->is_array())
        fail(file, data.name + " must be a list of numbers, not " + data.json->type_name());
    raw.values.reserve(data.json->size());
    for (const Json& value : *data.json) {
        raw.values.push_back(
            number_of(file, value, data.name + "[" + std::to_string(raw.values.size()) + "]"));
    }
    const Named count = find_named(*record, {"numPoints", "npts"});
    if (count.json) {
        // Some count samples, some steps.
        const double promised = number_of(file, *count.json, count.name);
        const auto found = static_cast<double>(raw.values.size());
        if (promised != found && promised != found - 1) {
            fail(file, "promises " + count.name + " " + count.json->dump() + ", but " + data.name +
                           " has " + counted(raw.values.size(), "number") +
                           "; it is cut short, or that entry is wrong");
        }
    }
    if (const Named factor = find_named(*record, {"factor"}); factor.json)
        raw.factor = number_of(file, *factor.json, factor.name);
    if (const Named unit = find_named(*record, {"unit", "units"}); unit.json) {
        if (!unit.json->is_string())
            fail(file, unit.name + " must be a string, not " + unit.json->type_name());
        const auto name = unit.json->get<std::string>();
        raw.unit_m_s2 = io::acceleration_unit_m_s2(name);
        if (!raw.unit_m_s2)
            fail(file,
                 unit.name + " is " + in_quotes(name) + ", but must be g, m/s^2, cm/s^2 or gal");
    }
    return raw;
}

// The units that a header names, in words of their own.
void collect_units(std::string_view line, std::set<double>& units) {
    std::string text = lower_case(line);
    for (char& c : text) {
        if (std::string_view("()[]{}<>:=_\"'#%!|").find(c) != std::string_view::npos) c = ' ';
    }
    std::string_view rest = text;
    for (auto word = io::next_token(rest, true); !word.empty(); word = io::next_token(rest, true)) {
        if (const auto unit = io::acceleration_unit_m_s2(word)) units.insert(*unit);
    }
}

// The one that a header names, or nothing.
std::optional<double> only_unit(const fs::path& file, const std::set<double>& units,
                                bool unit_given) {
    if (units.size() > 1 && !unit_given)
        fail(file, std::string("its header names several units; ") + mend);
    if (units.size() != 1) return std::nullopt;
    return *units.begin();
}

Raw read_text(const fs::path& file, std::string_view text, bool unit_given) {
    if (text.substr(0, 4096).find('\0') != std::string_view::npos) {
        fail(file, "is neither JSON nor text: it has zero bytes near its start");
    }
    if (auto record = io::read_at2(file, text))
        return {std::move(record->values), record->step_s, 1,
                only_unit(file, record->units_m_s2, unit_given)};
    Raw raw;
    std::vector<double> times;
    std::vector<std::uint64_t> line_of;
    std::set<double> units;
    io::Lines lines(text);
    const auto bad = [&](std::uint64_t line, const std::string& message) {
        fail(file, "line " + std::to_string(line) + ": " + message);
    };
    for (std::string_view line; lines.next(line);) {
        std::string_view rest = line.substr(0, line.find_first_of("#%!"));
        collect_units(line.substr(rest.size()), units);
        const auto first = io::next_token(rest, true), second = io::next_token(rest, true);
        if (first.empty()) continue;
        double time = 0, value = 0;
        if (!io::parse_number(first, time)) {
            // A header goes before all numbers.
            if (!times.empty()) bad(lines.number(), in_quotes(first) + " is not a number");
            collect_units(line, units);
            continue;
        }
        if (second.empty()) {
            bad(lines.number(), "one value, but time in seconds and acceleration are needed");
        }
        if (!io::parse_number(second, value))
            bad(lines.number(), in_quotes(second) + " is not a number");
        if (!std::isfinite(time) || !std::isfinite(value))
            bad(lines.number(),
                in_quotes(std::isfinite(time) ? second : first) + " is not a finite number");
        if (!times.empty() && time <= times.back()) {
            bad(lines.number(), "time " + short_number(time) + " after " +
                                    short_number(times.back()) + "; times must rise");
        }
        times.push_back(time);
        raw.values.push_back(value);
        line_of.push_back(lines.number());
    }
    if (times.size() < 2) return raw;
    raw.step_s = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    // Written with few digits, times are off by up to half a step; the worst gap tells where more
    // is wrong.
    double off = 0, worst = 0;
    std::size_t gap = 1;
    for (std::size_t n = 1; n < times.size(); ++n) {
        const double due = times.front() + raw.step_s * static_cast<double>(n);
        off = std::max(off, std::fabs(times[n] - due));
        const double uneven = std::fabs(times[n] - times[n - 1] - raw.step_s);
        if (uneven > worst) {
            worst = uneven;
            gap = n;
        }
    }
    if (off > 0.51 * raw.step_s) {
        bad(line_of[gap],
            "time " + short_number(times[gap]) + " is " +
                short_number(times[gap] - times[gap - 1]) +
                " s after the one before, but samples must be equally far apart, here " +
                short_number(raw.step_s) + " s");
    }
    raw.unit_m_s2 = only_unit(file, units, unit_given);
    return raw;
}

}  // namespace

double acceleration_unit_m_s2(const std::string& name) {
    if (const std::optional<double> unit = io::acceleration_unit_m_s2(name)) return *unit;
    throw Error(ErrorKind::usage,
                "accelerogram_unit (--accelerogram-unit) " + name + ": expected g, m/s2 or cm/s2");
}

Accelerogram read_accelerogram(const fs::path& file, std::optional<double> unit_m_s2) {
    const auto bytes = io::read_file(file, most_bytes);
    std::string_view text = bytes.text();
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
    const auto first = text.find_first_not_of(" \t\r\n");
    const bool json = first != std::string_view::npos && (text[first] == '{' || text[first] == '[');
    const Raw raw = json ? read_json(file, text) : read_text(file, text, unit_m_s2.has_value());
    if (raw.values.size() < 2) {
        fail(file,
             "has " + counted(raw.values.size(), "sample") +
                 "; a record needs at least 2, as JSON, as lines of time and acceleration, or "
                 "as PEER's .AT2");
    }
    if (raw.values.size() > most_samples)
        fail(file, "has " + counted(raw.values.size(), "sample") + ", more than the limit of " +
                       std::to_string(most_samples) + "; cut the strong part out of it");
    if (!(raw.step_s >= shortest_step_s && raw.step_s <= longest_step_s))
        fail(file, "its samples are " + short_number(raw.step_s) + " s apart, but must be from " +
                       short_number(shortest_step_s) + " to " + short_number(longest_step_s) +
                       " s; times are in seconds");
    Accelerogram record;
    record.step_s = raw.step_s;
    record.source = file.string();
    const std::optional<double> named = unit_m_s2 ? unit_m_s2 : raw.unit_m_s2;
    const double scale = raw.factor * named.value_or(g_m_s2);
    for (const double value : raw.values) record.m_s2.push_back(value * scale);
    if (record.duration_s() > longest_s)
        fail(file, "lasts " + short_number(record.duration_s()) + " s, more than the limit of " +
                       short_number(longest_s) + " s; cut the strong part out of it");
    const double peak_g = record.peak_m_s2() / g_m_s2;
    if (!(peak_g > 0)) fail(file, "has no acceleration: all its samples are 0");
    const double highest = named ? highest_g : highest_assumed_g;
    if (!(peak_g <= highest)) {
        fail(file, "its peak is " + short_number(peak_g) + " g" +
                       (named ? "" : " if its values are in g, as no unit is named") +
                       ", more than the limit of " + short_number(highest) + " g; " +
                       (named ? "its unit is probably another" : "the unit may be another") + ": " +
                       mend);
    }
    if (!named) {
        record.notes.push_back(
            "The accelerogram names no unit: its values were taken to be in g, "
            "so that its peak is " +
            short_number(peak_g) + " g.");
    }
    return record;
}

Accelerogram read_accelerogram(const fs::path& along, const std::optional<fs::path>& across,
                               const std::optional<fs::path>& up, std::optional<double> unit_m_s2) {
    Accelerogram record = read_accelerogram(along, unit_m_s2);
    const auto component = [&](const fs::path& file) {
        Accelerogram other = read_accelerogram(file, unit_m_s2);
        if (std::abs(other.step_s - record.step_s) > 1e-3 * record.step_s)
            fail(file, "its samples are " + io::short_number(other.step_s) +
                           " s apart, but those of " + record.source + " " +
                           io::short_number(record.step_s) + " s; give components of one record");
        other.m_s2.resize(record.m_s2.size(), 0.0);
        return std::move(other.m_s2);
    };
    if (across) record.across_m_s2 = component(*across);
    if (up) record.up_m_s2 = component(*up);
    return record;
}

}  // namespace topple
