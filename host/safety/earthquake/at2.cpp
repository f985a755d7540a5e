// SPDX-License-Identifier: MIT
#include "safety/earthquake/at2.h"

#include <cmath>
#include <cstdint>

#include "io/text.h"
#include "safety/earthquake/acceleration_units.h"

namespace topple::io {
namespace {

constexpr std::uint64_t most_header_lines = 10;
constexpr std::size_t longest_header_line = 1000;
// Beyond what any record has; a count is no reason to allocate.
constexpr double most_promised = 1e9;

// The number behind a word and "="; none where there is no such.
std::optional<double> number_behind(std::string_view line, std::string_view word) {
    const auto at = line.find(word);
    if (at == std::string_view::npos) return std::nullopt;
    std::string_view rest = line.substr(at + word.size());
    const auto equals = rest.find_first_not_of(' ');
    if (equals == std::string_view::npos || rest[equals] != '=') return std::nullopt;
    rest.remove_prefix(equals + 1);
    double value = 0;
    if (!parse_number(next_token(rest, true), value)) return std::nullopt;
    return value;
}

struct Promise {
    double samples = 0, step_s = 0;
};
std::optional<Promise> promise_of(std::string_view text) {
    if (text.size() > longest_header_line) return std::nullopt;
    const std::string line = lower_case(text);
    if (line.find("npts") == std::string::npos || line.find("dt") == std::string::npos)
        return std::nullopt;
    const auto samples = number_behind(line, "npts"), step = number_behind(line, "dt");
    if (samples && step) return Promise{*samples, *step};
    std::string_view rest = line;
    Promise out;
    if (parse_number(next_token(rest, true), out.samples) &&
        parse_number(next_token(rest, true), out.step_s))
        return out;
    return std::nullopt;
}

// What names the unit stands beside the word.
void collect_unit(std::string_view line, std::set<double>& units) {
    constexpr std::string_view before = "units of";
    const std::string text = lower_case(line);
    const auto at = text.find(before);
    if (at == std::string::npos) return;
    std::string_view rest = std::string_view(text).substr(at + before.size());
    std::string_view word = next_token(rest, true);
    while (word.ends_with('.')) word.remove_suffix(1);
    if (const auto unit = acceleration_unit_m_s2(word)) units.insert(*unit);
}

}  // namespace

std::optional<At2Record> read_at2(const std::filesystem::path& file, std::string_view text) {
    At2Record out;
    Lines lines(text);
    std::optional<Promise> promise;
    for (std::string_view line; !promise && lines.next(line);) {
        if (lines.number() > most_header_lines) return std::nullopt;
        promise = promise_of(line);
        if (!promise) collect_unit(line, out.units_m_s2);
    }
    if (!promise) return std::nullopt;
    out.step_s = promise->step_s;
    const auto bad = [&](const std::string& message) {
        fail(file, "line " + std::to_string(lines.number()) + ": " + message);
    };
    if (!(promise->samples >= 0 && promise->samples <= most_promised &&
          promise->samples == std::floor(promise->samples)))
        bad("NPTS is " + short_number(promise->samples) + ", which is no number of samples");
    const auto count = static_cast<std::size_t>(promise->samples);
    for (std::string_view line; lines.next(line);) {
        for (auto token = next_token(line, true); !token.empty(); token = next_token(line, true)) {
            double value = 0;
            if (!parse_number(token, value)) bad(in_quotes(token) + " is not a number");
            if (!std::isfinite(value)) bad(in_quotes(token) + " is not a finite number");
            if (out.values.size() == count)
                bad("more samples than the " + std::to_string(count) + " that NPTS promises");
            out.values.push_back(value);
        }
    }
    if (out.values.size() < count)
        fail(file, "promises NPTS " + std::to_string(count) + ", but has " +
                       counted(out.values.size(), "sample") +
                       "; it is cut short, or that entry is wrong");
    return out;
}

}  // namespace topple::io
